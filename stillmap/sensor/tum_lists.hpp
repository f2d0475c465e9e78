// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "stillmap/sensor/tum_sequence.hpp"

namespace stillmap {

/// The pairs of a sequence's folder, in the order of their stamps. Reads the lists for TumSequence.
[[nodiscard]] std::vector<SequenceEntry> read_sequence_entries(const std::filesystem::path& folder);

}  // namespace stillmap
