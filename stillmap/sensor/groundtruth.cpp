// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/groundtruth.hpp"

#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/stamps.hpp"

namespace stillmap {

GroundTruth read_groundtruth(const std::filesystem::path& path, const ReadingOptions& options) {
  GroundTruth truth;
  try {
    ReadTrajectory read = read_trajectory_with_gaps(path);
    truth.poses = std::move(read.poses);
    if (read.rows_left_out > 0) {
      truth.warnings.push_back(fmt::format(
          "{}: {} rows without a finite pose are left out", path.string(), read.rows_left_out));
    }
  } catch (const Error& error) {
    truth.warnings.push_back(fmt::format("no ground truth: {}", error.what()));
    return truth;
  }
  std::vector<Stamp> stamps;
  stamps.reserve(truth.poses.size());
  for (const StampedPose& pose : truth.poses) stamps.push_back(pose.stamp);
  // The option is about the images: true poses follow it where they are counted as images are.
  ReadingOptions own = options;
  if (guess_stamp_unit(stamps) != StampUnit::kFrames) own.stamp_unit.reset();
  stamps = in_seconds(std::move(stamps), own).stamps;
  for (std::size_t i = 0; i < stamps.size(); ++i) truth.poses[i].stamp = std::move(stamps[i]);
  return truth;
}

}  // namespace stillmap
