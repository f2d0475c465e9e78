// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/pose_at.hpp"

#include <algorithm>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/sensor/associate.hpp"

namespace stillmap {

std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory, double stamp_s) {
  const auto seconds = [](const StampedPose& pose) { return pose.stamp.seconds; };
  const auto after = std::ranges::lower_bound(trajectory, stamp_s, {}, seconds);
  const bool has_after =
      after != trajectory.end() && seconds(*after) - stamp_s < kMaxStampDifferenceS;
  const bool has_before =
      after != trajectory.begin() && stamp_s - seconds(*std::prev(after)) < kMaxStampDifferenceS;
  if (!has_after && !has_before) return std::nullopt;
  if (after == trajectory.end()) return trajectory.back().T_world_camera;
  if (after == trajectory.begin()) return after->T_world_camera;
  const StampedPose& before = *std::prev(after);
  const double s = (stamp_s - seconds(before)) / (seconds(*after) - seconds(before));
  return interpolate(before.T_world_camera, after->T_world_camera, s);
}

}  // namespace stillmap
