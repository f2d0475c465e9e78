// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/truth_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stillmap/io/ply.hpp"

namespace stillmap {
namespace {

constexpr double kHalfRoomM = 2.0;
constexpr int kWalker = 1, kChair = 10;

struct Ball {
  int id;
  Eigen::Vector3d center;
  double radius;
};

struct Images {
  ColorImage color;
  DepthImage depth;
  ObjectMask ids;
};

CameraModel test_camera() {
  CameraModel camera;
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx = camera.fy = 130;
  camera.cx = 80;
  camera.cy = 60;
  camera.k1 = 0.1;  // that rays are the distorted camera's
  return camera;
}

// A cube of a room with balls in it, by the equations of planes and spheres.
Images look(const Eigen::Isometry3d& T_world_camera, const std::vector<Ball>& balls) {
  const cv::Mat2f rays = pixel_rays(test_camera());
  Images images{ColorImage(cv::Mat3b(rays.size(), cv::Vec3b(200, 20, 30))),
                DepthImage(cv::Mat1f(rays.size())),
                ObjectMask(cv::Mat1b(rays.size(), std::uint8_t{0}))};
  const Eigen::Vector3d o = T_world_camera.translation();
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      const Eigen::Vector3d d =
          T_world_camera.linear() * Eigen::Vector3d(rays(v, u)[0], rays(v, u)[1], 1.0);
      double z = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 3; ++i) {
        if (d[i] != 0) z = std::min(z, ((d[i] > 0 ? kHalfRoomM : -kHalfRoomM) - o[i]) / d[i]);
      }
      for (const Ball& ball : balls) {
        const Eigen::Vector3d c = o - ball.center;
        const double a = d.squaredNorm(), b = d.dot(c);
        const double root = b * b - a * (c.squaredNorm() - ball.radius * ball.radius);
        const double near = root < 0 ? z : (-b - std::sqrt(root)) / a;
        if (near <= 0 || near >= z) continue;
        z = near;
        images.ids.mat(v, u) = static_cast<std::uint8_t>(ball.id);
        images.color.mat(v, u) = cv::Vec3b(static_cast<std::uint8_t>(ball.id), 0, 0);
      }
      images.depth.mat(v, u) = static_cast<float>(z);
    }
  }
  return images;
}

Eigen::Isometry3d pose_of(int frame) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() =
      Eigen::AngleAxisd(0.02 * frame, Eigen::Vector3d(0.3, 1.0, 0.1).normalized())
          .toRotationMatrix();
  T_world_camera.translation() = Eigen::Vector3d(0.01 * frame, -0.2, -0.9);
  return T_world_camera;
}

// The walker comes from the left until it nearly touches the chair.
std::vector<Ball> balls_at(int frame) {
  return {{kWalker, {-0.8 + 0.08 * frame, -0.1, 1.1}, 0.35}, {kChair, {0.5, -0.5, 1.0}, 0.25}};
}

TruthMaps maps_of_walk(const TruthMapOptions& options = {}, int frames = 12) {
  const std::array<int, 1> moved = {kWalker};
  TruthMaps maps(test_camera(), moved, options);
  for (int frame = 0; frame < frames; ++frame) {
    const Images images = look(pose_of(frame), balls_at(frame));
    maps.add(images.color, images.depth, images.ids, pose_of(frame));
  }
  return maps;
}

double distance_to_room(const Eigen::Vector3d& p) {
  return std::abs(p.cwiseAbs().maxCoeff() - kHalfRoomM);
}

double distance_to_ball(const Eigen::Vector3d& p, const Ball& ball) {
  return std::abs((p - ball.center).norm() - ball.radius);
}

TEST(TruthMaps, StaticPointsLieOnWhatNeverMoves) {
  const PointCloud cloud = maps_of_walk().static_map();
  std::size_t of_walls = 0, of_chair = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.positions[i].cast<double>();
    const bool on_chair = cloud.colors[i][0] == kChair;
    const double distance = on_chair ? distance_to_ball(p, balls_at(0)[1]) : distance_to_room(p);
    ASSERT_LT(distance, 2e-6) << p.transpose();
    (on_chair ? of_chair : of_walls) += 1;
  }
  EXPECT_GT(of_walls, 5000U);
  EXPECT_GT(of_chair, 500U);
}

TEST(TruthMaps, StaticSurfaceIsCoveredWhereItWasSeen) {
  // Also behind the walker once it has left: the wall at its first position.
  const PointCloud cloud = maps_of_walk().static_map();
  for (const Eigen::Vector3f& place :
       {Eigen::Vector3f(-0.8F, -0.1F, 2.F), Eigen::Vector3f(0.F, 0.F, 2.F)}) {
    const auto covers = [&](const Eigen::Vector3f& p) { return (p - place).norm() < 0.02F; };
    EXPECT_TRUE(std::ranges::any_of(cloud.positions, covers));
  }
}

TEST(TruthMaps, DynamicPointsLieOnWhatMoves) {
  const PointCloud cloud = maps_of_walk().dynamic_map();
  for (const Eigen::Vector3f& position : cloud.positions) {
    double nearest = 1.0;
    for (int frame = 0; frame < 12; ++frame) {
      nearest =
          std::min(nearest, distance_to_ball(position.cast<double>(), balls_at(frame).front()));
    }
    ASSERT_LT(nearest, 2e-6);
  }
  EXPECT_GT(cloud.size(), 3000U);
}

/// A chair that stands, is pushed in frames 4 to 6, and stands again; a walker who stands still.
TruthMaps maps_of_push(int frames) {
  const std::array<int, 2> moved = {kWalker, kChair};
  const std::array<int, 1> pushed = {kChair};
  TruthMaps maps(test_camera(), moved, {});
  for (int frame = 0; frame < frames; ++frame) {
    const double x = 0.5 + 0.15 * std::clamp(frame - 3, 0, 3);
    const Images images =
        look(pose_of(frame), {{kWalker, {-0.8, -0.1, 1.1}, 0.35}, {kChair, {x, -0.5, 1.0}, 0.25}});
    const bool moves = frame >= 4 && frame <= 6;
    maps.add(images.color,
             images.depth,
             images.ids,
             pose_of(frame),
             moves ? std::span<const int>(pushed) : std::span<const int>());
  }
  return maps;
}

TEST(TruthMaps, AMovedThingRestsWhereItWasLastSeenToStand) {
  for (const auto& [frames, x] : {std::pair(4, 0.5), std::pair(12, 0.95)}) {
    const PointCloud cloud = maps_of_push(frames).resting_map();
    EXPECT_GT(cloud.size(), 300U);
    for (const Eigen::Vector3f& p : cloud.positions) {
      ASSERT_LT(distance_to_ball(p.cast<double>(), {kChair, {x, -0.5, 1.0}, 0.25}), 2e-6);
    }
  }
  EXPECT_TRUE(maps_of_push(6).resting_map().empty());  // seen to leave, not seen to stand since
}

TEST(TruthMaps, DynamicPointsKeepAwayFromStaticOnes) {
  const TruthMaps maps = maps_of_walk();
  const PointCloud still = maps.static_map();
  TruthMapOptions without;
  without.clearance_m = 1e-7;
  const PointCloud swept = maps_of_walk(without).dynamic_map();
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3f& p : swept.positions) {
    const bool near = std::ranges::any_of(still.positions, [&](const Eigen::Vector3f& q) {
      return (p.cast<double>() - q.cast<double>()).norm() <= 0.05;
    });
    if (!near) expected.push_back(p);
  }
  EXPECT_EQ(maps.dynamic_map().positions, expected);
  EXPECT_LT(expected.size(), swept.size()) << "the walker comes near the chair";
  EXPECT_GT(expected.size(), swept.size() / 2);
}

TEST(TruthMaps, AreTheSameBytesForTheSameFrames) {
  const TruthMaps a = maps_of_walk(), b = maps_of_walk();
  EXPECT_EQ(encode_ply(a.static_map()), encode_ply(b.static_map()));
  EXPECT_EQ(encode_ply(a.dynamic_map()), encode_ply(b.dynamic_map()));
}

TEST(TruthMaps, ACameraThatStandsStillSeesEveryPixel) {
  // With tiny voxels every pixel makes a point: four frames of a quarter of the pixels each.
  TruthMapOptions options;
  options.voxel_size_m = 0.001;
  TruthMaps maps(test_camera(), {}, options);
  const Images images = look(pose_of(0), {});
  for (int frame = 0; frame < 3; ++frame) {
    maps.add(images.color, images.depth, images.ids, pose_of(0));
  }
  EXPECT_EQ(maps.static_map().size(), 3U * 160 * 120 / 4);
  for (int frame = 0; frame < 3; ++frame) {
    maps.add(images.color, images.depth, images.ids, pose_of(0));
  }
  EXPECT_EQ(maps.static_map().size(), 160U * 120);
}

TEST(TruthMaps, LeavesOutWhatASensorDoesNotReach) {
  TruthMapOptions options;
  options.min_depth_m = 1.0;
  options.max_depth_m = 2.5;
  const Eigen::Isometry3d T_world_camera = pose_of(0);
  TruthMaps maps(test_camera(), {}, options);
  Images images = look(T_world_camera, balls_at(0));
  images.depth.mat(0, 0) = 0.F;
  images.depth.mat(2, 2) = std::numeric_limits<float>::quiet_NaN();
  images.depth.mat(4, 4) = std::numeric_limits<float>::infinity();
  maps.add(images.color, images.depth, images.ids, T_world_camera);
  const PointCloud cloud = maps.static_map();
  double nearest = 10, farthest = 0;
  for (const Eigen::Vector3f& position : cloud.positions) {
    const double z = (T_world_camera.inverse() * position.cast<double>()).z();
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  EXPECT_GE(nearest, 1.0 - 1e-5);
  EXPECT_LE(farthest, 2.5 + 1e-5);
  EXPECT_GT(cloud.size(), 100U);
}

}  // namespace
}  // namespace stillmap
