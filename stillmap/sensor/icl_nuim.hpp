// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder is a sequence of the ICL-NUIM data set: a list of pairs beside a file
/// *.gt.freiburg, or the renderer's own scene_*.depth files.
[[nodiscard]] bool is_icl_nuim(const std::filesystem::path& folder);

/// Reads the "TUM RGB-D compatible PNGs" of ICL-NUIM (Handa et al. 2014): depth along the optical
/// axis, 5000 a metre, frame numbers as stamps. Its published poses are of a camera whose y axis
/// points up (hence the published focal length fy = -480); they are reflected, so that y points
/// down as in the images, with fy = 480. Throws Error as open_tum_lists() does, and for the
/// renderer's own files, whose depth is along the ray.
[[nodiscard]] SequenceContent open_icl_nuim(const std::filesystem::path& folder,
                                            const ReadingOptions& options);

}  // namespace stillmap
