// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/ray_rotation.hpp"

#include <limits>

#include <Eigen/SVD>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/cauchy.hpp"

namespace stillmap {
namespace {

Eigen::Vector3d ray(const CameraModel& camera, const Eigen::Vector2d& px) {
  return camera.unproject(px, 1.0).normalized();
}

}  // namespace

Eigen::Matrix3d ray_rotation(const CameraModel& camera, std::span<const PointMatch> matches) {
  STILLMAP_CHECK(matches.size() >= 3);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const double scale_px : {50.0, 10.0, 3.0, 1.5}) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const PointMatch& match : matches) {
      const Eigen::Vector3d from = ray(camera, match.previous_px);
      const Eigen::Vector3d to = ray(camera, match.current_px);
      const double squared = (camera.fx * (to - R * from)).squaredNorm();
      sum += cauchy_weight(squared, scale_px) * to * from.transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
    R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  }
  return R;
}

double rotation_residual_px(const CameraModel& camera,
                            const Eigen::Matrix3d& R_current_previous,
                            const PointMatch& match) {
  const Eigen::Vector3d turned = R_current_previous * camera.unproject(match.previous_px, 1.0);
  if (!(turned.z() > 0)) return std::numeric_limits<double>::infinity();
  return (camera.project(turned) - match.current_px).norm();
}

}  // namespace stillmap
