// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/map_alignment.hpp"

#include <utility>
#include <vector>

#include "stillmap/geometry/rigid_alignment.hpp"
#include "tooling/eval/pose_pairs.hpp"

namespace stillmap {
namespace {

void append_frame(std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& T_world_camera) {
  constexpr double kLever_m = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-kLever_m, kLever_m}) {
      points.push_back(T_world_camera * (side * Eigen::Vector3d::Unit(axis)));
    }
  }
}

}  // namespace

std::optional<Eigen::Isometry3d> map_alignment(const Trajectory& groundtruth,
                                               const Trajectory& estimate) {
  const std::vector<std::pair<std::size_t, std::size_t>> pairs = pair_poses(groundtruth, estimate);
  if (pairs.size() < 3) return std::nullopt;
  std::vector<Eigen::Vector3d> truth, estimated;
  for (const auto& [i, j] : pairs) {
    append_frame(truth, groundtruth[i].T_world_camera);
    append_frame(estimated, estimate[j].T_world_camera);
  }
  return align_rigid(estimated, truth);
}

}  // namespace stillmap
