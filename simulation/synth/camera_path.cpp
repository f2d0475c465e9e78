// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/camera_path.hpp"

#include <cmath>
#include <numbers>

namespace stillmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double wave(double t_s, double period_s, double phase = 0.0) {
  return std::sin(2.0 * std::numbers::pi * t_s / period_s + phase);
}

// Where the camera looks, in radians. Yaw is counted from +x towards +y, pitch upwards, roll
// clockwise as seen by the camera.
struct View {
  double yaw;
  double pitch;
  double roll;
};

Eigen::Isometry3d pose_at(const Eigen::Vector3d& position, const View& view) {
  Eigen::Matrix3d R_world_level;  // camera axes (right, down, forward) of a camera looking at +x
  R_world_level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(view.yaw, Eigen::Vector3d::UnitZ()) * R_world_level *
               Eigen::AngleAxisd(view.pitch, Eigen::Vector3d::UnitX()) *
               Eigen::AngleAxisd(view.roll, Eigen::Vector3d::UnitZ());
  T.translation() = position;
  return T;
}

Eigen::Isometry3d looking_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  const Eigen::Vector3d d = target - position;
  return pose_at(position,
                 {std::atan2(d.y(), d.x()), std::atan2(d.z(), std::hypot(d.x(), d.y())), 0.0});
}

const Eigen::Vector3d kStand(-0.4, 0.1, 1.25);  // in front of the desk, at eye level of a chair
constexpr double kStandPitch = -14.0 * kDegree;

Eigen::Isometry3d xyz_path(double t_s) {
  const Eigen::Vector3d offset(
      0.22 * wave(t_s, 7.0), 0.26 * wave(t_s, 8.3, 0.7), 0.12 * wave(t_s, 5.1, 1.9));
  return pose_at(kStand + offset,
                 {2.5 * kDegree * wave(t_s, 5.7),
                  kStandPitch + 2.0 * kDegree * wave(t_s, 4.3, 0.4),
                  1.5 * kDegree * wave(t_s, 6.1, 1.1)});
}

Eigen::Isometry3d rpy_path(double t_s) {
  const Eigen::Vector3d offset(
      0.02 * wave(t_s, 4.7), 0.03 * wave(t_s, 5.9, 0.3), 0.02 * wave(t_s, 3.9, 1.2));
  return pose_at(kStand + offset,
                 {15.0 * kDegree * wave(t_s, 9.1),
                  kStandPitch + 8.0 * kDegree * wave(t_s, 6.7, 0.5),
                  12.0 * kDegree * wave(t_s, 8.0, 1.3)});
}

Eigen::Isometry3d halfsphere_path(double t_s) {
  constexpr double kRadius = 0.5;
  const double azimuth = 55.0 * kDegree * wave(t_s, 13.0);
  const double elevation = kDegree * (30.0 + 28.0 * wave(t_s, 9.0, -1.0));
  const Eigen::Vector3d offset(-std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth),
                               std::sin(elevation));
  const Eigen::Vector3d centre(0.1, 0.2, 0.95), target(1.5, 0.3, 0.85);
  return looking_at(centre + kRadius * offset, target);
}

Eigen::Isometry3d static_path(double t_s) {
  const Eigen::Vector3d offset(
      0.003 * wave(t_s, 3.1), 0.004 * wave(t_s, 4.3, 0.9), 0.002 * wave(t_s, 2.7, 2.0));
  return pose_at(kStand + offset,
                 {0.25 * kDegree * wave(t_s, 3.7),
                  kStandPitch + 0.2 * kDegree * wave(t_s, 2.9, 0.2),
                  0.15 * kDegree * wave(t_s, 3.3, 1.5)});
}

Eigen::Isometry3d loop_path(double t_s) {
  const double period = loop_period_s();
  constexpr double kRadius = 0.75;
  const double angle = 2.0 * std::numbers::pi * t_s / period;
  const Eigen::Vector3d position(kRadius * std::cos(angle) - 0.2,
                                 kRadius * std::sin(angle),
                                 1.3 + 0.06 * wave(t_s, period / 5.0));
  return pose_at(position,
                 {angle,
                  (-10.0 + 4.0 * wave(t_s, period / 4.0)) * kDegree,
                  2.0 * kDegree * wave(t_s, period / 3.0)});
}

}  // namespace

double loop_period_s() {
  return 20.0;
}

Eigen::Isometry3d T_world_camera(PathKind kind, double t_s) {
  switch (kind) {
    case PathKind::kXyz:
      return xyz_path(t_s);
    case PathKind::kRpy:
      return rpy_path(t_s);
    case PathKind::kHalfsphere:
      return halfsphere_path(t_s);
    case PathKind::kStatic:
      return static_path(t_s);
    case PathKind::kLoop:
      return loop_path(t_s);
  }
  return xyz_path(t_s);
}

}  // namespace stillmap
