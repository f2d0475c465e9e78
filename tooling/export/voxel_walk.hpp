// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace stillmap {

/// The voxel of a point: voxel i covers [i, i + 1) * edge along each axis.
[[nodiscard]] inline Eigen::Vector3i voxel_of(const Eigen::Vector3d& p, double edge_m) {
  return (p / edge_m).array().floor().cast<int>();
}

/// The voxels on the line from one point to another, in order, including the first and the last
/// (Amanatides and Woo 1987). Consecutive voxels share a face.
class VoxelWalk {
 public:
  VoxelWalk(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double edge_m)
      : at_(voxel_of(from, edge_m)), left_((voxel_of(to, edge_m) - at_).cwiseAbs()) {
    const Eigen::Vector3i last = voxel_of(to, edge_m);
    for (int axis = 0; axis < 3; ++axis) {
      if (left_[axis] == 0) continue;
      step_[axis] = last[axis] > at_[axis] ? 1 : -1;
      const double length = to[axis] - from[axis];
      const double border = edge_m * (at_[axis] + (step_[axis] > 0 ? 1 : 0));
      next_[axis] = (border - from[axis]) / length;
      width_[axis] = edge_m / std::abs(length);
    }
  }

  [[nodiscard]] const Eigen::Vector3i& voxel() const { return at_; }
  [[nodiscard]] bool at_end() const { return (left_.array() == 0).all(); }

  /// Must not be called at the end.
  void advance() {
    // Remaining steps are counted, so that rounding can move a step but never miss the last voxel.
    int axis = -1;
    for (int i = 0; i < 3; ++i) {
      if (left_[i] > 0 && (axis < 0 || next_[i] < next_[axis])) axis = i;
    }
    at_[axis] += step_[axis];
    next_[axis] += width_[axis];
    --left_[axis];
  }

 private:
  Eigen::Vector3i at_;
  Eigen::Vector3i left_;
  Eigen::Vector3i step_ = Eigen::Vector3i::Zero();
  // position on the line of the next step of each axis
  Eigen::Vector3d next_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d width_ = Eigen::Vector3d::Zero();  // distance between two steps of each axis
};

}  // namespace stillmap
