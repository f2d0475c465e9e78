// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/time_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <vector>

namespace stillmap {

std::optional<TimeSummary> summarize_times(std::span<const double> values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double value) {
    return std::isfinite(value);
  });
  if (sorted.empty()) return std::nullopt;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
  const std::size_t rank95 = (95 * n + 99) / 100;  // in integers: 0.95 * 20 must give 19, not 20
  return TimeSummary{.mean = sum / static_cast<double>(n),
                     .median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
                     .p95 = sorted[rank95 - 1],
                     .max = sorted.back()};
}

}  // namespace stillmap
