// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <random>

#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"

// Synthetic problems with known answers, for the tests and benchmarks of this module.
namespace stillmap {

/// Numbers are drawn into variables where the arguments of a call would draw them: their order is
/// each compiler's own.
class TestRandom {
 public:
  explicit TestRandom(std::uint32_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double normal(double sigma) { return sigma * normal_(engine_); }
  Vector6d twist(double sigma_m, double sigma_rad) {
    Vector6d step;
    for (int i = 0; i < 6; ++i) step[i] = normal(i < 3 ? sigma_m : sigma_rad);
    return step;
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

/// The measurements that have a depth.
enum class Depths { kNone, kSome, kAll };

inline constexpr double kInverseDepthSigma = 0.005;

/// A measurement of `p_camera`, off by `noise` sigmas in each part (0 = exact).
inline PointMeasurement measure_point(const CameraModel& camera,
                                      const Eigen::Vector3d& p_camera,
                                      Depths depths,
                                      double noise,
                                      TestRandom& random) {
  const double sigma_px = random.uniform(0.7, 2.5);
  PointMeasurement m;
  const double off_y = random.normal(noise * sigma_px), off_x = random.normal(noise * sigma_px);
  m.px = camera.project(p_camera) + Eigen::Vector2d(off_x, off_y);
  m.pixel_weight = 1.0 / sigma_px;
  if (depths == Depths::kNone || (depths == Depths::kSome && random.uniform(0, 1) < 0.4)) return m;
  m.inverse_depth = 1.0 / p_camera.z() + random.normal(noise * kInverseDepthSigma);
  m.inverse_depth_weight = 1.0 / kInverseDepthSigma;
  return m;
}

struct PoseScene {
  CameraModel camera;
  Eigen::Isometry3d T_camera_world;
  std::vector<PoseObservation> observations;
};

inline PoseScene make_pose_scene(std::uint32_t seed, int count, Depths depths, double noise) {
  TestRandom random(seed);
  PoseScene scene{builtin_camera("tum_fr3"), Eigen::Isometry3d::Identity(), {}};
  scene.T_camera_world = perturb_left(scene.T_camera_world, random.twist(1.0, 0.7));
  for (int i = 0; i < count; ++i) {
    const double y = random.uniform(0, 480), x = random.uniform(0, 640);
    const Eigen::Vector2d px(x, y);
    const Eigen::Vector3d p_camera = scene.camera.unproject(px, random.uniform(0.8, 5.0));
    scene.observations.push_back({scene.T_camera_world.inverse() * p_camera,
                                  measure_point(scene.camera, p_camera, depths, noise, random)});
  }
  return scene;
}

/// Cameras side by side before a box of points: the exact poses and points, measured with noise.
/// The first two cameras are fixed. `seen` is the share of cameras that see a point.
struct BundleSceneSpec {
  std::uint32_t seed = 1;
  int cameras = 8;
  int points = 200;
  double seen = 1.0;
  double noise = 0;
};

inline BundleProblem make_bundle(const BundleSceneSpec& spec) {
  TestRandom random(spec.seed);
  BundleProblem problem;
  problem.camera = builtin_camera("tum_fr3");
  for (int c = 0; c < spec.cameras; ++c) {
    const Eigen::Vector3d position((c - 0.5 * (spec.cameras - 1)) * 1.2 / spec.cameras, 0, 0);
    const Eigen::Isometry3d T = make_pose(Eigen::Quaterniond::Identity(), -position);
    problem.T_camera_world.push_back(perturb_left(T, random.twist(0.05, 0.03)));
    problem.held.push_back(c < 2 ? 1 : 0);
  }
  while (std::ssize(problem.points) < spec.points) {
    const double z = random.uniform(1.5, 4.5), y = random.uniform(-1.2, 1.2);
    const Eigen::Vector3d p_world(random.uniform(-1.5, 1.5), y, z);
    const auto point = static_cast<std::uint32_t>(problem.points.size());
    std::vector<BundleObservation> seen_by;
    for (std::uint32_t c = 0; c < problem.T_camera_world.size(); ++c) {
      const Eigen::Vector3d p_camera = problem.T_camera_world[c] * p_world;
      const Eigen::Vector2d px = problem.camera.project(p_camera);
      if (px.x() < 0 || px.x() > 640 || px.y() < 0 || px.y() > 480) continue;
      if (random.uniform(0, 1) > spec.seen) continue;
      seen_by.push_back(
          {c, point, measure_point(problem.camera, p_camera, Depths::kSome, spec.noise, random)});
    }
    if (seen_by.size() < 2) continue;
    problem.points.push_back(p_world);
    problem.observations.insert(problem.observations.end(), seen_by.begin(), seen_by.end());
  }
  return problem;
}

/// The same problem with its free poses and its points displaced.
inline BundleProblem perturbed(BundleProblem problem, std::uint32_t seed, double sigma) {
  TestRandom random(seed);
  for (std::size_t c = 0; c < problem.held.size(); ++c) {
    if (problem.held[c] != 0) continue;
    problem.T_camera_world[c] =
        perturb_left(problem.T_camera_world[c], random.twist(sigma, 0.5 * sigma));
  }
  for (Eigen::Vector3d& p : problem.points) p += random.twist(sigma, 0).head<3>();
  return problem;
}

/// Distance between two poses, as the larger of metres and radians.
inline double pose_distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d between = a * b.inverse();
  return std::max(between.translation().norm(), rotation_angle(between.linear()));
}

}  // namespace stillmap
