// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// The names of a sequence's colour images without their ending, by the text of their stamps: what
/// masks of other programs are named after.
[[nodiscard]] inline std::map<std::string, std::string> image_names(
    std::span<const SequenceEntry> entries) {
  std::map<std::string, std::string> names;
  for (const SequenceEntry& entry : entries) {
    names.emplace(entry.stamp.text, entry.color_file.stem().string());
  }
  return names;
}

}  // namespace stillmap
