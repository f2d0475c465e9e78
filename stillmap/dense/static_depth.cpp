// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/static_depth.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/depth_islands.hpp"

namespace stillmap {
namespace {

/// Depths over 0 and up to the limit, without the pixels of `excluded`.
cv::Mat1f within(const cv::Mat1f& depth, const Mask& excluded, float max_depth_m) {
  cv::Mat1f kept(depth.size());
  const auto columns = static_cast<std::size_t>(depth.cols);
  for (int row = 0; row < depth.rows; ++row) {
    const float* z = depth[row];
    float* out = kept[row];
    for (std::size_t x = 0; x < columns; ++x) {
      out[x] = z[x] > 0 && z[x] <= max_depth_m ? z[x] : 0.0F;  // excludes NaN, too
    }
    if (excluded.empty()) continue;
    const std::uint8_t* left_out = excluded.mat[row];
    for (std::size_t x = 0; x < columns; ++x) out[x] = left_out[x] != 0 ? 0.0F : out[x];
  }
  return kept;
}

}  // namespace

cv::Mat1f static_depth(const cv::Mat1f& depth,
                       const Mask& dynamic,
                       const StaticDepthConfig& config) {
  STILLMAP_CHECK(dynamic.empty() || dynamic.mat.size() == depth.size());
  cv::Mat1f kept = within(depth, dynamic, std::numeric_limits<float>::max());
  if (config.edges == "fixed") kept = without_fixed_edges(kept, config.edge.step_m);
  if (config.edges == "growing") kept = without_edges(kept, config.edge);
  if (config.islands == "on") {
    kept = without_islands(kept, config.min_island_share * static_cast<double>(depth.total()));
  }
  return within(kept, {}, static_cast<float>(config.max_depth_m));
}

}  // namespace stillmap
