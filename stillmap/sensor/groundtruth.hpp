// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// What `read()` gives; where it throws an Error, no poses and a warning that says why.
template <class Read>
[[nodiscard]] GroundTruth groundtruth_or_warning(const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    return {{}, {fmt::format("no ground truth: {}", error.what())}};
  }
}

/// True poses in the TUM format. Rows with a number that is not finite are left out, and counted in
/// a warning; a file that cannot be used for another reason gives a warning and no poses. Stamps in
/// another unit than seconds are converted, as those of images are.
[[nodiscard]] GroundTruth read_groundtruth(const std::filesystem::path& path,
                                           const ReadingOptions& options);

/// True poses of frames that have a file each, `pose_file(colour image)`, of the 16 numbers of
/// T_world_camera, row by row, metres. Warnings as above; a frame whose file is missing has no
/// pose.
[[nodiscard]] GroundTruth read_pose_files(
    const std::vector<SequenceEntry>& entries,
    const std::function<std::filesystem::path(const std::filesystem::path& color)>& pose_file);

/// True poses of a trajectory.log as Open3D and the Redwood data sets have it: five lines a frame,
/// of which the first begins with its number, counted from 0, and the others are T_world_camera.
[[nodiscard]] GroundTruth read_pose_log(const std::filesystem::path& path,
                                        const std::vector<SequenceEntry>& entries);

}  // namespace stillmap
