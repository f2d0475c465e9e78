// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/depth_units.hpp"

namespace stillmap {

DepthImage depth_of_units(const cv::Mat1w& units, double depth_factor) {
  cv::Mat1f metres(units.size());
  const float factor = static_cast<float>(depth_factor);
  for (int v = 0; v < units.rows; ++v) {
    const std::uint16_t* source = units[v];
    float* target = metres[v];
    for (int u = 0; u < units.cols; ++u) {
      target[u] = source[u] == kSaturatedDepth ? 0.0F : static_cast<float>(source[u]) / factor;
    }
  }
  return DepthImage(metres);
}

}  // namespace stillmap
