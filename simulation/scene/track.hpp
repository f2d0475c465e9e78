// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace stillmap {

/// From 0 to 1 while `x` does, with no velocity and no acceleration at either end; held outside.
[[nodiscard]] double ease(double x);

/// A number that rests at one key's value, eases to the next one's, and so on.
class EasedTrack {
 public:
  struct Key {
    double t_s;
    double value;
  };

  /// Keys by rising time, one at least. Between two keys of equal value it rests.
  explicit EasedTrack(std::vector<Key> keys);

  [[nodiscard]] double at(double t_s) const;

 private:
  std::vector<Key> keys_;
};

/// A position and a direction on the floor.
struct FloorPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double yaw = 0;

  [[nodiscard]] Eigen::Vector2d forward() const { return {std::cos(yaw), std::sin(yaw)}; }

  /// A place `ahead` in front of it and `left` to its left.
  [[nodiscard]] Eigen::Vector2d place(double ahead, double left) const {
    return position + Eigen::Rotation2Dd(yaw) * Eigen::Vector2d(ahead, left);
  }

  /// In world axes, at a height.
  [[nodiscard]] Eigen::Isometry3d T_world(double z) const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << position, z;
    T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T;
  }
};

/// A point of a path at a time. Without a yaw, the direction is that of the path.
struct PathKey {
  double t_s;
  double x;
  double y;
  std::optional<double> yaw = std::nullopt;
  bool stops = false;
};

/// A path over the floor through keys, with continuous velocity (cubic Hermite pieces); it rests
/// before the first key, after the last, and at keys that stop.
class FloorPath {
 public:
  /// Keys by rising time, one at least; the first, the last and those that stop have a yaw, and
  /// yaws are not wrapped: from 0 to -4 turns right.
  explicit FloorPath(const std::vector<PathKey>& keys);

  [[nodiscard]] FloorPose at(double t_s) const;

 private:
  struct Knot {
    double t_s;
    Eigen::Vector3d value;  // x, y, yaw
    Eigen::Vector3d rate;
  };

  std::vector<Knot> knots_;
};

}  // namespace stillmap
