// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/nanodet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct LevelSize {
  int columns = 0;
  std::size_t cells = 0, classes = 0, bins = 0;
};

LevelSize level_size(const NanoDetLevel& level, cv::Size input) {
  STILLMAP_CHECK(level.stride > 0);
  const TensorShape scores = without_batch(level.scores.shape, 2);
  const TensorShape boxes = without_batch(level.boxes.shape, 2);
  const int columns = (input.width + level.stride - 1) / level.stride;
  const std::int64_t cells =
      std::int64_t{columns} * ((input.height + level.stride - 1) / level.stride);
  const bool fits = scores.size() == 2 && boxes.size() == 2 && scores[0] == cells &&
                    boxes[0] == cells && boxes[1] > 0 && boxes[1] % 4 == 0 &&
                    element_count(scores) == std::ssize(level.scores.values) &&
                    element_count(boxes) == std::ssize(level.boxes.values);
  if (!fits) {
    throw Error("NanoDet's outputs {} and {} at stride {}: expected {} cells each",
                shape_text(level.scores.shape),
                shape_text(level.boxes.shape),
                level.stride,
                cells);
  }
  return {columns,
          static_cast<std::size_t>(cells),
          static_cast<std::size_t>(scores[1]),
          static_cast<std::size_t>(boxes[1]) / 4};
}

// The mean bin number of a distribution that is given by logits.
double mean_bin(std::span<const float> logits) {
  const float largest = *std::ranges::max_element(logits);
  double sum = 0, weighted = 0;
  for (std::size_t i = 0; i < logits.size(); ++i) {
    const double weight = std::exp(static_cast<double>(logits[i]) - largest);
    sum += weight;
    weighted += weight * static_cast<double>(i);
  }
  return weighted / sum;
}

PixelBox cell_box(const NanoDetLevel& level, const LevelSize& size, std::size_t cell) {
  std::array<double, 4> distance{};
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t first = (cell * 4 + side) * size.bins;
    distance[side] = level.stride * mean_bin(level.boxes.values.subspan(first, size.bins));
  }
  const auto columns = static_cast<std::size_t>(size.columns);
  const double x = (static_cast<double>(cell % columns) + 0.5) * level.stride;
  const double y = (static_cast<double>(cell / columns) + 0.5) * level.stride;
  return {x - distance[0], y - distance[1], x + distance[2], y + distance[3]};
}

}  // namespace

std::vector<Candidate> decode_nanodet(std::span<const NanoDetLevel> levels,
                                      cv::Size input,
                                      float min_score) {
  std::vector<Candidate> candidates;
  int source = 0;
  for (const NanoDetLevel& level : levels) {
    const LevelSize size = level_size(level, input);
    for (std::size_t cell = 0; cell < size.cells; ++cell, ++source) {
      for (std::size_t label = 0; label < size.classes; ++label) {
        const float score = level.scores.values[cell * size.classes + label];
        if (!(score >= min_score)) continue;
        candidates.push_back({static_cast<int>(label), score, cell_box(level, size, cell), source});
      }
    }
  }
  return candidates;
}

}  // namespace stillmap
