// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {

Statistics statistics(std::span<const double> values) {
  STILLMAP_CHECK(!values.empty());
  const double count = static_cast<double>(values.size());
  double sum = 0, sum_of_squares = 0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  const double mean = sum / count;
  double sum_of_deviations = 0;
  for (const double value : values) sum_of_deviations += (value - mean) * (value - mean);

  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const std::size_t half = sorted.size() / 2;
  const bool odd = sorted.size() % 2 == 1;
  return {.rmse = std::sqrt(sum_of_squares / count),
          .mean = mean,
          .median = odd ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]),
          .std = std::sqrt(sum_of_deviations / count),
          .min = sorted.front(),
          .max = sorted.back()};
}

}  // namespace stillmap
