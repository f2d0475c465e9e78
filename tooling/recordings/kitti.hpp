// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder has calib.txt, times.txt and the images of two cameras as the sequences of
/// KITTI's odometry benchmark have.
[[nodiscard]] bool is_kitti(const std::filesystem::path& folder);

/// Reads stereo pairs in the layout of KITTI's odometry benchmark: image_2/ and image_3/ (colour),
/// else image_0/ and image_1/ (gray), with numbers as names, row n of times.txt the stamp of image
/// n in seconds, rectified by the matrices P0 to P3 of calib.txt. True poses come from poses.txt in
/// the folder, else from ../../poses/NAME.txt as the data set has it; they are those of the left
/// camera. Throws Error, with file and line, for a broken list or calibration, and where there is
/// no pair.
[[nodiscard]] SequenceContent open_kitti(const std::filesystem::path& folder,
                                         const ReadingOptions& options);

}  // namespace stillmap
