// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Geometry>

#include "stillmap/slam/optim/pose_graph.hpp"

namespace stillmap {

/// A pose as parameters of Ceres: quaternion (x, y, z, w), then translation.
using PoseBlock = std::array<double, 7>;

[[nodiscard]] inline PoseBlock pose_block(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

[[nodiscard]] inline Eigen::Isometry3d pose_of(const PoseBlock& block) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(block.data()).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(block.data() + 4);
  return T;
}

/// The error of an edge, in sigmas: the translation of E = T_from_to^-1 T_from^-1 T_to and twice
/// the vector part of its quaternion, which is the rotation vector for small angles.
class PoseResidual {
 public:
  explicit PoseResidual(const PoseGraphEdge& edge)
      : q_to_from_(Eigen::Quaterniond(edge.T_from_to.linear()).conjugate()),
        t_from_to_(edge.T_from_to.translation()),
        weight_m_(1.0 / edge.sigma_m),
        weight_rad_(1.0 / edge.sigma_rad) {}

  template <class T>
  bool operator()(const T* from, const T* to, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Quaternion = Eigen::Quaternion<T>;
    const Eigen::Map<const Quaternion> q_from(from), q_to(to);
    const Eigen::Map<const Vector> t_from(from + 4), t_to(to + 4);
    const Quaternion q_measured = q_to_from_.template cast<T>();
    const Quaternion q_error = q_measured * (q_from.conjugate() * q_to);
    const Vector between = q_from.conjugate() * (t_to - t_from);
    // q and -q are one rotation; takes the smaller angle.
    const T sign = q_error.w() < T(0) ? T(-1) : T(1);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> errors(residual);
    errors.template head<3>() =
        T(weight_m_) * (q_measured * (between - t_from_to_.template cast<T>()));
    errors.template tail<3>() = T(2 * weight_rad_) * sign * q_error.vec();
    return true;
  }

 private:
  Eigen::Quaterniond q_to_from_;
  Eigen::Vector3d t_from_to_;
  double weight_m_, weight_rad_;
};

}  // namespace stillmap
