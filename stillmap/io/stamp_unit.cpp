// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/stamp_unit.hpp"

#include <algorithm>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Today's clock in seconds: the years 1998 to 2065.
constexpr double kFirstToday = 9e8, kLastToday = 3e9;

bool today(double stamp, double units_per_second) {
  return stamp >= kFirstToday * units_per_second && stamp <= kLastToday * units_per_second;
}

// Of neighbouring stamps that differ; 0 where there are none.
double median_step(std::span<const Stamp> stamps) {
  std::vector<double> sorted;
  sorted.reserve(stamps.size());
  for (const Stamp& stamp : stamps) sorted.push_back(stamp.seconds);
  std::ranges::sort(sorted);
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

bool digits_alone(const Stamp& stamp) {
  return stamp.text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::string_view stamp_unit_words(StampUnit unit) {
  const auto found = std::ranges::find(kStampUnitNames, unit, &StampUnitName::unit);
  STILLMAP_CHECK(found != kStampUnitNames.end());
  return found->words;
}

StampUnit stamp_unit_by_size(double stamp) {
  if (today(stamp, 1e3)) return StampUnit::kMilliseconds;
  if (today(stamp, 1e6)) return StampUnit::kMicroseconds;
  if (today(stamp, 1e9)) return StampUnit::kNanoseconds;
  return StampUnit::kSeconds;
}

StampUnit guess_stamp_unit(std::span<const Stamp> stamps) {
  if (stamps.empty()) return StampUnit::kSeconds;
  const double largest = std::ranges::max(stamps, {}, &Stamp::seconds).seconds;
  const double step = median_step(stamps);
  if (today(largest, 1) && step < 1e3) return StampUnit::kSeconds;
  if (step > 1e6) return StampUnit::kNanoseconds;
  if (step > 1e3) return StampUnit::kMicroseconds;
  if (step > 10) return StampUnit::kMilliseconds;
  if (const StampUnit by_size = stamp_unit_by_size(largest); by_size != StampUnit::kSeconds) {
    return by_size;
  }
  const bool counted = std::ranges::all_of(stamps, digits_alone);
  return counted && step > 0 ? StampUnit::kFrames : StampUnit::kSeconds;
}

double seconds_per(StampUnit unit, double rate_hz) {
  switch (unit) {
    case StampUnit::kMilliseconds:
      return 1e-3;
    case StampUnit::kMicroseconds:
      return 1e-6;
    case StampUnit::kNanoseconds:
      return 1e-9;
    case StampUnit::kFrames:
      return 1.0 / rate_hz;
    case StampUnit::kSeconds:
      break;
  }
  return 1.0;
}

}  // namespace stillmap
