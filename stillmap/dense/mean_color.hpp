// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// The rounded mean of `count` > 0 colours of which these are the sums.
[[nodiscard]] inline Rgb mean_color(const std::array<std::uint32_t, 3>& sum, std::uint32_t count) {
  Rgb mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    mean[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
  }
  return mean;
}

}  // namespace stillmap
