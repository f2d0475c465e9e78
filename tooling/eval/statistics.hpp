// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace stillmap {

struct Statistics {
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;
};

/// Statistics of at least one value, as in numpy: `std` divides by the number of values, and the
/// median of an even number of values is the mean of the middle two.
[[nodiscard]] Statistics statistics(std::span<const double> values);

}  // namespace stillmap
