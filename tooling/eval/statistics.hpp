// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace stillmap {

struct Statistics {
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;
};

/// Of at least one value. As numpy has them: `std` divides by the number of values, the median of
/// an even number of values is the mean of the middle two.
[[nodiscard]] Statistics statistics(std::span<const double> values);

}  // namespace stillmap
