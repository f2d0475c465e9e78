// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/pose_pairs.hpp"

namespace stillmap {
namespace {

std::vector<double> seconds_of(const Trajectory& trajectory) {
  std::vector<double> seconds;
  seconds.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) seconds.push_back(pose.stamp.seconds);
  return seconds;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pair_poses(const Trajectory& groundtruth,
                                                            const Trajectory& estimate,
                                                            double max_difference_s) {
  return associate(seconds_of(groundtruth), seconds_of(estimate), max_difference_s);
}

}  // namespace stillmap
