// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// The unit in which a list gives its stamps.
enum class StampUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds, kFrames };

/// A unit and its names.
struct StampUnitName {
  StampUnit unit;
  std::string_view option;  ///< on the command line
  std::string_view words;   ///< in a sentence
};

/// The names of all units.
inline constexpr std::array<StampUnitName, 5> kStampUnitNames = {
    {{StampUnit::kSeconds, "s", "seconds"},
     {StampUnit::kMilliseconds, "ms", "milliseconds"},
     {StampUnit::kMicroseconds, "us", "microseconds"},
     {StampUnit::kNanoseconds, "ns", "nanoseconds"},
     {StampUnit::kFrames, "frames", "frame numbers"}}};

/// The unit's name in a sentence.
[[nodiscard]] std::string_view stamp_unit_words(StampUnit unit);

/// The unit of the stamps of a camera's images, in any order, by what a camera can do: an image
/// every millisecond to every 10 s. Their median distance tells the unit, and their size where that
/// is not enough: stamps of today's clock have 10 digits as seconds and 3 more for each smaller
/// unit. Texts of digits alone in steps of 10 at most are frame numbers, unless they are as large
/// as today's seconds.
[[nodiscard]] StampUnit guess_stamp_unit(std::span<const Stamp> stamps);

/// The unit of a stamp that is as large as only today's clock makes it, else seconds.
[[nodiscard]] StampUnit stamp_unit_by_size(double stamp);

/// Seconds for one unit; `rate_hz` is that of the frames, where these are counted.
[[nodiscard]] double seconds_per(StampUnit unit, double rate_hz);

}  // namespace stillmap
