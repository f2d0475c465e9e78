// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/detr.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

bool is_table(const Tensor& tensor) {
  return tensor.shape.size() == 2 && element_count(tensor.shape) > 0 &&
         element_count(tensor.shape) == std::ssize(tensor.values);
}

Tensor table_of(const Tensor& output) {
  return {without_batch(output.shape, 2), output.values};
}

// Some columns of a table.
Tensor columns_of(const Tensor& table, std::size_t first, std::size_t count) {
  const auto step = static_cast<std::size_t>(table.shape[1]);
  Tensor part{{table.shape[0], static_cast<std::int64_t>(count)}, {}};
  for (std::size_t row = 0; row < table.values.size(); row += step) {
    const std::span<const float> values = std::span(table.values).subspan(row + first, count);
    part.values.insert(part.values.end(), values.begin(), values.end());
  }
  return part;
}

// Exports end before or after the sigmoid. Before it, every frame has queries far below 0, because
// most of the queries find nothing.
bool are_logits(std::span<const float> scores) {
  return std::ranges::any_of(scores, [](float score) { return score < 0 || score > 1; });
}

PixelBox checked_box(std::span<const float> sides, cv::Size input) {
  constexpr float kMostBeyond = 1;
  for (const float side : sides) {
    if (side >= -kMostBeyond && side <= 1 + kMostBeyond) continue;
    throw Error("a side of a box at {}, expected shares of the image, from 0 to 1", side);
  }
  const double x = sides[0], y = sides[1];
  const double half_width = sides[2] / 2.0, half_height = sides[3] / 2.0;
  return {(x - half_width) * input.width,
          (y - half_height) * input.height,
          (x + half_width) * input.width,
          (y + half_height) * input.height};
}

}  // namespace

DetrOutputs detr_outputs(const NetworkExport& network, const std::vector<Tensor>& outputs) {
  const Tensor first = table_of(outputs.at(network.outputs.at(0)));
  if (network.outputs.size() == 2) return {first, table_of(outputs.at(network.outputs[1]))};
  if (!is_table(first) || first.shape[1] <= 4) {
    throw Error("RT-DETR's output {}: expected 1xQx(4+C)", shape_text(first.shape));
  }
  return {columns_of(first, 0, 4),
          columns_of(first, 4, static_cast<std::size_t>(first.shape[1]) - 4)};
}

std::vector<Candidate> decode_detr(const DetrOutputs& outputs, cv::Size input, float min_score) {
  const TensorShape &boxes = outputs.boxes.shape, &scores = outputs.scores.shape;
  if (!is_table(outputs.boxes) || !is_table(outputs.scores) || boxes[0] != scores[0] ||
      boxes[1] != 4) {
    throw Error("RT-DETR's outputs {} and {}: expected 1xQx4 and 1xQxC",
                shape_text(boxes),
                shape_text(scores));
  }
  const auto classes = static_cast<std::size_t>(scores[1]);
  const bool logits = are_logits(outputs.scores.values);
  std::vector<Candidate> candidates;
  for (std::size_t query = 0; query < static_cast<std::size_t>(boxes[0]); ++query) {
    const std::span<const float> row =
        std::span(outputs.scores.values).subspan(query * classes, classes);
    const auto best = std::ranges::max_element(row);
    const float score = logits ? 1 / (1 + std::exp(-*best)) : *best;
    const PixelBox box = checked_box(std::span(outputs.boxes.values).subspan(query * 4, 4), input);
    if (!(score >= min_score)) continue;
    candidates.push_back(
        {static_cast<int>(best - row.begin()), score, box, static_cast<int>(query)});
  }
  return candidates;
}

}  // namespace stillmap
