// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/ransac.hpp"

#include <cmath>

namespace stillmap {

int ransac_iterations(int inliers, std::size_t population, std::size_t sample_size, int at_most) {
  const double share = static_cast<double>(inliers) / static_cast<double>(population);
  const double good = std::pow(share, static_cast<double>(sample_size));
  if (good >= 1.0) return 1;
  const double needed = std::log(0.005) / std::log1p(-good);
  return needed < at_most ? static_cast<int>(std::ceil(needed)) : at_most;
}

}  // namespace stillmap
