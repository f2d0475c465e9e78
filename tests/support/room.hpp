// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// 320 x 240 pixels, 63 degrees wide.
inline CameraModel test_camera() {
  CameraModel camera;
  camera.name = "test";
  camera.width_px = 320;
  camera.height_px = 240;
  camera.fx = camera.fy = 260;
  camera.cx = 160;
  camera.cy = 120;
  return camera;
}

/// A camera in a frame with z up: at `p`, looking along x turned left by `yaw`, down by `pitch`.
inline Eigen::Isometry3d looking(const Eigen::Vector3d& p, double yaw_deg, double pitch_deg) {
  const double degree = M_PI / 180;
  Eigen::Matrix3d level;  // columns: right, down, forward
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_deg * degree, Eigen::Vector3d::UnitZ()) *
               Eigen::AngleAxisd(pitch_deg * degree, Eigen::Vector3d::UnitY()) * level;
  T.translation() = p;
  return T;
}

/// A rectangle from a corner along two edges, with a point in the middle of each square centimetre.
inline void add_rectangle(PointCloud& cloud,
                          const Eigen::Vector3d& corner,
                          const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
  const int along_a = static_cast<int>(std::lround(a.norm() * 100));
  const int along_b = static_cast<int>(std::lround(b.norm() * 100));
  for (int i = 0; i < along_a; ++i) {
    for (int j = 0; j < along_b; ++j) {
      const Eigen::Vector3d p = corner + (i + 0.5) / along_a * a + (j + 0.5) / along_b * b;
      cloud.positions.push_back(p.cast<float>());
      cloud.colors.push_back({200, 100, 50});
      cloud.labels.push_back(0);
    }
  }
}

/// A box room with a table, z up, 0 on the floor. Floor: x 0 to 3, y 0 to 4. Walls 2.5 m high at
/// x = 3.02 and y = 0 and 4; a wall of another room at x = 5. The table's top: x 1.5 to 2.1, y 1.6
/// to 2.4, at 0.72 m.
struct TestRoom {
  PointCloud cloud;
  CameraModel camera = test_camera();
  std::vector<Eigen::Isometry3d> poses = {looking({0.3, 2.0, 1.2}, 0, 20),
                                          looking({0.3, 2.0, 1.2}, 30, 25),
                                          looking({0.3, 2.0, 1.2}, -30, 25),
                                          looking({0.3, 2.1, 1.2}, 0, 0)};

  TestRoom() {
    using Eigen::Vector3d;
    add_rectangle(cloud, {0, 0, 0}, {3, 0, 0}, {0, 4, 0});
    add_rectangle(cloud, {3.02, 0, 0}, {0, 4, 0}, {0, 0, 2.5});
    add_rectangle(cloud, {0, 0, 0}, {3, 0, 0}, {0, 0, 2.5});
    add_rectangle(cloud, {0, 4, 0}, {3, 0, 0}, {0, 0, 2.5});
    add_rectangle(cloud, {5, 0, 0}, {0, 4, 0}, {0, 0, 2.5});
    add_rectangle(cloud, {1.5, 1.6, 0.72}, {0.6, 0, 0}, {0, 0.8, 0});
  }

  /// The room in the coordinates of its first camera, as in a run.
  [[nodiscard]] Eigen::Isometry3d T_world_room() const { return poses.front().inverse(); }

  void move(const Eigen::Isometry3d& T) {
    for (Eigen::Vector3f& p : cloud.positions) p = (T * p.cast<double>()).cast<float>();
    for (Eigen::Isometry3d& pose : poses) pose = T * pose;
  }

  void add_noise(double sigma_m) {
    std::mt19937 rng(1);
    std::normal_distribution<float> noise(0, static_cast<float>(sigma_m));
    for (Eigen::Vector3f& p : cloud.positions)
      p += Eigen::Vector3f(noise(rng), noise(rng), noise(rng));
  }
};

}  // namespace stillmap
