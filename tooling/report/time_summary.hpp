// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace stillmap {

/// Statistics of times; the unit is that of the values.
struct TimeSummary {
  double mean = 0;
  double median = 0;  ///< mean of the two middle values where their count is even
  double p95 = 0;     ///< nearest rank: the smallest value with at least 95 % of all at or below it
  double max = 0;
};

/// Nothing for no values. Values that are not finite are left out.
[[nodiscard]] std::optional<TimeSummary> summarize_times(std::span<const double> values);

}  // namespace stillmap
