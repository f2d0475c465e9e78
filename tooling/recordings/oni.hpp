// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Reads a recording of OpenNI (*.oni): the first stream of depth and the first of colour (RGB888,
/// plain or as JPEG). Images are paired by their stamps. The camera is a pinhole with the field of
/// view of the colour stream, where that is told. Throws Error where a stream is missing, and for a
/// size of depth other than that of colour.
[[nodiscard]] SequenceContent open_oni(const std::filesystem::path& path,
                                       const ReadingOptions& options);

}  // namespace stillmap
