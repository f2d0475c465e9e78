// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Stamps in seconds, with the texts that they were read from.
struct UnitStamps {
  std::vector<Stamp> stamps;
  StampUnit unit = StampUnit::kSeconds;  ///< of the texts
};

/// The stamps that a list has as numbers of its own unit: that of the options, else the one that
/// they look like.
[[nodiscard]] UnitStamps in_seconds(std::vector<Stamp> stamps, const ReadingOptions& options);

/// A note of what the stamps of `list` are taken for; none for seconds.
[[nodiscard]] Remarks unit_remark(const std::string& list,
                                  StampUnit unit,
                                  const ReadingOptions& options);

/// A stamp that no list has: its text gives microseconds.
[[nodiscard]] Stamp stamp_of_seconds(double seconds);

/// The last number in the name of each file; nothing where a name has none that is a stamp.
[[nodiscard]] std::optional<std::vector<Stamp>> numbers_in_names(
    std::span<const std::filesystem::path> files);

/// The options with the unit of numbers in the names of images. Small whole numbers are frame
/// numbers even in large steps: every 20th frame is common in exports, a clock that began with the
/// recording is not.
[[nodiscard]] ReadingOptions with_unit_of_names(std::span<const Stamp> numbers,
                                                const ReadingOptions& options);

}  // namespace stillmap
