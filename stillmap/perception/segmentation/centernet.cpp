// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/centernet.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct HeatMap {
  int rows = 0, columns = 0, classes = 0;
  std::span<const float> values;

  [[nodiscard]] std::size_t cell(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int row, int column, int label) const {
    return values[cell(row, column) * static_cast<std::size_t>(classes) +
                  static_cast<std::size_t>(label)];
  }
};

// Among equal neighbours the first, row by row, is the maximum.
bool is_peak(const HeatMap& heat, int row, int column, int label) {
  const float value = heat.at(row, column, label);
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, heat.rows - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, heat.columns - 1); ++c) {
      const bool earlier = heat.cell(r, c) < heat.cell(row, column);
      const float other = heat.at(r, c, label);
      if (other > value || (earlier && other == value)) return false;
    }
  }
  return true;
}

HeatMap heat_map(const TensorView& heat, const TensorView& sizes) {
  const TensorShape shape = without_batch(heat.shape, 3);
  const TensorShape size_shape = without_batch(sizes.shape, 3);
  const bool fits = shape.size() == 3 && size_shape.size() == 3 && shape[0] == size_shape[0] &&
                    shape[1] == size_shape[1] && size_shape[2] == 4 && element_count(shape) > 0 &&
                    element_count(shape) == std::ssize(heat.values) &&
                    element_count(size_shape) == std::ssize(sizes.values);
  if (!fits) {
    throw Error("CenterNet's outputs {} and {}: expected 1xHxWxC and 1xHxWx4",
                shape_text(heat.shape),
                shape_text(sizes.shape));
  }
  return {static_cast<int>(shape[0]),
          static_cast<int>(shape[1]),
          static_cast<int>(shape[2]),
          heat.values};
}

}  // namespace

std::vector<Candidate> decode_centernet(const TensorView& heat_output,
                                        const TensorView& sizes,
                                        cv::Size input,
                                        float min_score) {
  const HeatMap heat = heat_map(heat_output, sizes);
  const double step_x = static_cast<double>(input.width) / heat.columns;
  const double step_y = static_cast<double>(input.height) / heat.rows;
  std::vector<Candidate> candidates;
  for (int row = 0; row < heat.rows; ++row) {
    for (int column = 0; column < heat.columns; ++column) {
      for (int label = 0; label < heat.classes; ++label) {
        const float score = heat.at(row, column, label);
        if (!(score >= min_score) || !is_peak(heat, row, column, label)) continue;
        const std::size_t cell = heat.cell(row, column);
        const std::span<const float> to_edge = sizes.values.subspan(cell * 4, 4);
        const double x = column * step_x, y = row * step_y;
        candidates.push_back({label,
                              score,
                              {x - to_edge[0], y - to_edge[1], x + to_edge[2], y + to_edge[3]},
                              static_cast<int>(cell)});
      }
    }
  }
  return candidates;
}

}  // namespace stillmap
