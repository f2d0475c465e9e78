// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder, or mav0/ in it, has the lists of two cameras as the EuRoC data sets have.
[[nodiscard]] bool is_euroc(const std::filesystem::path& folder);

/// Reads stereo pairs in the layout of the EuRoC data sets: cam0/ and cam1/, each with data.csv
/// (stamps in ns), data/ and sensor.yaml, which calibrates a pinhole with the distortion
/// "radial-tangential". Images of equal stamps are a pair. True poses are those of
/// state_groundtruth_estimate0/data.csv, of the rectified left camera. Throws Error, with file and
/// line or key, for a broken list or calibration, and where there is no pair.
[[nodiscard]] SequenceContent open_euroc(const std::filesystem::path& folder,
                                         const ReadingOptions& options);

}  // namespace stillmap
