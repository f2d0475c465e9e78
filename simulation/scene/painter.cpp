// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/painter.hpp"

#include <numbers>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {

PictureSeed Painter::next_seed() {
  return mix_bits((std::uint64_t{seed_} << 32U) | pictures_++);
}

Eigen::Isometry3d placed(double x, double y, double z, double yaw_deg) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const double yaw = yaw_deg * std::numbers::pi / 180.0;
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

}  // namespace stillmap
