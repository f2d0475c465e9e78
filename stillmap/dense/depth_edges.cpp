// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/depth_edges.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace stillmap {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();

/// The least and the greatest depth of two rows, for each column; kFar and 0 where both are
/// missing. There is one column more than in the image, in which depth is missing.
struct ColumnRange {
  std::vector<float> nearest, farthest;
};

void set_range(ColumnRange& range, const float* upper, const float* lower, std::size_t columns) {
  float* nearest = range.nearest.data();
  float* farthest = range.farthest.data();
  for (std::size_t x = 0; x < columns; ++x) {  // branch-free, so that it vectorises
    const float a = upper[x], b = lower[x];
    const bool has_a = a > 0 && a<kFar, has_b = b> 0 && b < kFar;
    nearest[x] = std::min(has_a ? a : kFar, has_b ? b : kFar);
    farthest[x] = std::max(has_a ? a : 0.0F, has_b ? b : 0.0F);
  }
}

}  // namespace

cv::Mat1f without_edges(const cv::Mat1f& depth, const DepthEdgesConfig& config) {
  cv::Mat1f kept(depth.size());
  const auto columns = static_cast<std::size_t>(depth.cols);
  const auto step = static_cast<float>(config.step_m);
  const auto growth = static_cast<float>(config.step_per_m);
  ColumnRange range{std::vector<float>(columns + 1, kFar), std::vector<float>(columns + 1, 0.0F)};
  for (int row = 0; row < depth.rows; ++row) {
    const float* z = depth[row];
    set_range(range, z, depth[std::min(row + 1, depth.rows - 1)], columns);
    float* out = kept[row];
    for (std::size_t x = 0; x < columns; ++x) {
      const float nearest = std::min(range.nearest[x], range.nearest[x + 1]);
      const float farthest = std::max(range.farthest[x], range.farthest[x + 1]);
      const float limit = std::max(step, growth * nearest * nearest);
      out[x] = farthest - nearest > limit ? 0.0F : z[x];
    }
  }
  return kept;
}

cv::Mat1f without_fixed_edges(const cv::Mat1f& depth, double step_m) {
  cv::Mat1f kept = depth.clone();
  const auto step = static_cast<float>(step_m);
  for (int row = 0; row + 1 < depth.rows; ++row) {
    const float *upper = depth[row], *lower = depth[row + 1];
    float* out = kept[row];
    for (int x = 0; x + 1 < depth.cols; ++x) {
      const float nearest = std::min({upper[x], upper[x + 1], lower[x], lower[x + 1]});
      const float farthest = std::max({upper[x], upper[x + 1], lower[x], lower[x + 1]});
      if (farthest - nearest > step) out[x] = 0;
    }
  }
  return kept;
}

}  // namespace stillmap
