// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// The formats of recordings in one file, then folder_formats(), then those of stereo pairs.
/// Formats whose library this build lacks are recognised too; opening them says so.
[[nodiscard]] std::span<const SequenceFormat> recording_formats();

}  // namespace stillmap
