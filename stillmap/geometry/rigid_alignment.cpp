// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/rigid_alignment.hpp"

#include <Eigen/SVD>

#include "stillmap/core/error.hpp"

namespace stillmap {

Eigen::Isometry3d align_rigid(std::span<const Eigen::Vector3d> source,
                              std::span<const Eigen::Vector3d> target) {
  STILLMAP_CHECK(!source.empty() && source.size() == target.size());
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    source_mean += source[i];
    target_mean += target[i];
  }
  source_mean /= static_cast<double>(source.size());
  target_mean /= static_cast<double>(source.size());

  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    covariance += (target[i] - target_mean) * (source[i] - source_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;

  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  T.translation() = target_mean - T.linear() * source_mean;
  return T;
}

}  // namespace stillmap
