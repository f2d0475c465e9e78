// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/ssd.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr double kShift = 0.1;  // variance of the offsets in the training of such networks
constexpr double kGrowth = 0.2;

struct Count {
  std::size_t anchors = 0, classes = 0;
};

Count count_of(const SsdOutputs& outputs) {
  const TensorShape anchors = without_batch(outputs.anchors.shape, 2);
  const TensorShape offsets = without_batch(outputs.offsets.shape, 2);
  const TensorShape classes = without_batch(outputs.classes.shape, 2);
  const bool fits = anchors.size() == 2 && anchors[1] == 4 && offsets == anchors &&
                    classes.size() == 2 && classes[0] == anchors[0] && classes[1] >= 2 &&
                    element_count(anchors) == std::ssize(outputs.anchors.values) &&
                    element_count(offsets) == std::ssize(outputs.offsets.values) &&
                    element_count(classes) == std::ssize(outputs.classes.values);
  if (!fits) {
    throw Error("anchors {}, offsets {} and classes {}: expected Nx4, 1xNx4 and 1xNxC",
                shape_text(outputs.anchors.shape),
                shape_text(outputs.offsets.shape),
                shape_text(outputs.classes.shape));
  }
  return {static_cast<std::size_t>(classes[0]), static_cast<std::size_t>(classes[1])};
}

bool are_probabilities(std::span<const float> row) {
  double sum = 0;
  for (const float value : row) {
    if (!(value >= 0 && value <= 1)) return false;
    sum += value;
  }
  return std::abs(sum - 1) < 1e-3;
}

std::vector<float> probabilities(std::span<const float> row) {
  std::vector<float> values(row.begin(), row.end());
  const float largest = *std::ranges::max_element(values);
  float sum = 0;
  for (float& value : values) sum += value = std::exp(value - largest);
  for (float& value : values) value /= sum;
  return values;
}

PixelBox anchor_box(std::span<const float> anchor, std::span<const float> offset, cv::Size input) {
  const double width = anchor[2] * std::exp(kGrowth * offset[2]);
  const double height = anchor[3] * std::exp(kGrowth * offset[3]);
  const double x = anchor[0] + anchor[2] * (0.5 + kShift * offset[0]);
  const double y = anchor[1] + anchor[3] * (0.5 + kShift * offset[1]);
  return {(x - width / 2) * input.width,
          (y - height / 2) * input.height,
          (x + width / 2) * input.width,
          (y + height / 2) * input.height};
}

}  // namespace

std::vector<Candidate> decode_ssd(const SsdOutputs& outputs, cv::Size input, float min_score) {
  const Count count = count_of(outputs);
  std::vector<Candidate> candidates;
  const bool ready =
      count.anchors > 0 && are_probabilities(outputs.classes.values.first(count.classes));
  for (std::size_t i = 0; i < count.anchors; ++i) {
    const std::span<const float> row =
        outputs.classes.values.subspan(i * count.classes, count.classes);
    const std::vector<float> scores =
        ready ? std::vector<float>(row.begin(), row.end()) : probabilities(row);
    for (std::size_t label = 1; label < count.classes; ++label) {
      if (!(scores[label] >= min_score)) continue;
      const PixelBox box = anchor_box(outputs.anchors.values.subspan(i * 4, 4),
                                      outputs.offsets.values.subspan(i * 4, 4),
                                      input);
      candidates.push_back({static_cast<int>(label) - 1, scores[label], box, static_cast<int>(i)});
    }
  }
  return candidates;
}

}  // namespace stillmap
