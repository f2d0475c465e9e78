// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/dense/free_space.hpp"
#include "stillmap/dense/global_cloud.hpp"
#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/dense/static_depth.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

/// A wavy wall, 1.5 to 3.5 m away, with a colour gradient.
RgbdFrame wall(const CameraModel& camera) {
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(camera.height_px, camera.width_px));
  frame.color = ColorImage(cv::Mat3b(camera.height_px, camera.width_px));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      frame.depth.mat(y, x) = static_cast<float>(2.5 + std::sin(x * 0.02) * std::cos(y * 0.03));
      frame.color.mat(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(x / 3), static_cast<std::uint8_t>(y / 2), 100);
    }
  }
  return frame;
}

/// All work for a key frame's cloud, in mode `full`.
void make_local_cloud(benchmark::State& state) {
  const CameraModel camera = builtin_camera("tum_fr3");
  const RgbdFrame frame = wall(camera);
  const cv::Mat2f rays = pixel_rays(camera);
  cv::Mat1b dynamic(frame.depth.mat.size(), std::uint8_t{0});
  dynamic(cv::Rect(100, 100, 80, 300)).setTo(1);
  StaticDepthConfig config;
  config.edges = "growing";
  config.islands = "on";
  std::size_t points = 0;
  for (auto _ : state) {
    const cv::Mat1f depth = static_depth(frame.depth.mat, Mask(dynamic), config);
    const PointCloud cloud = local_cloud(depth, frame.color, rays, {});
    points = cloud.size();
    benchmark::DoNotOptimize(cloud.positions.data());
  }
  state.counters["points"] = static_cast<double>(points);
}
BENCHMARK(make_local_cloud)->Unit(benchmark::kMillisecond);

void clean_depth(benchmark::State& state) {
  const RgbdFrame frame = wall(builtin_camera("tum_fr3"));
  StaticDepthConfig config;
  config.edges = "growing";
  config.islands = "on";
  for (auto _ : state) {
    benchmark::DoNotOptimize(static_depth(frame.depth.mat, {}, config).data);
  }
}
BENCHMARK(clean_depth)->Unit(benchmark::kMillisecond);

/// Key frames 10 cm and about 3 degrees apart that all see such a wall.
void assemble_global_cloud(benchmark::State& state) {
  const CameraModel camera = builtin_camera("tum_fr3");
  PointCloud local =
      local_cloud(wall(camera).depth.mat, wall(camera).color, pixel_rays(camera), {});
  local.positions.resize(std::min<std::size_t>(local.size(), 60000));
  local.colors.resize(local.size());
  const CompactCloud view = compact(local);
  std::vector<PosedCloud> clouds;
  for (int i = 0; i < state.range(0); ++i) {
    clouds.push_back({make_pose(so3_exp({0, 0.05 * i, 0}), {0.1 * i, 0, 0}), &view});
  }
  std::size_t points = 0;
  for (auto _ : state) {
    const PointCloud cloud = global_cloud(clouds, 0.01);
    points = cloud.size();
    benchmark::DoNotOptimize(cloud.positions.data());
  }
  state.counters["points_in"] = static_cast<double>(local.size() * clouds.size());
  state.counters["points_out"] = static_cast<double>(points);
}
BENCHMARK(assemble_global_cloud)->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond);

void make_range_image(benchmark::State& state) {
  const RgbdFrame frame = wall(builtin_camera("tum_fr3"));
  cv::Mat1b moving(frame.depth.mat.size(), std::uint8_t{0});
  moving(cv::Rect(100, 100, 80, 300)).setTo(1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        range_image(frame.depth.mat, {Mask(moving), Mask(moving)}, {}).cells.data());
  }
}
BENCHMARK(make_range_image)->Unit(benchmark::kMillisecond);

/// The free-space verdict of 100 key frames, 5 degrees apart, on the points of their map.
void check_free_space(benchmark::State& state) {
  const CameraModel camera = builtin_camera("tum_fr3");
  const RgbdFrame frame = wall(camera);
  const CompactCloud local =
      compact(local_cloud(frame.depth.mat, frame.color, pixel_rays(camera), {}));
  const RangeImage range = range_image(frame.depth.mat, {}, {});
  std::vector<PosedCloud> clouds;
  std::vector<PosedRange> ranges;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d T_world_keyframe = make_pose(so3_exp({0, 0.087 * i, 0}), {0, 0, 0});
    clouds.push_back({T_world_keyframe, &local});
    ranges.push_back({T_world_keyframe, &range});
  }
  const PointCloud map = global_cloud(clouds, 0.01);
  for (auto _ : state) {
    benchmark::DoNotOptimize(without_moved(map, ranges, camera, {}).positions.data());
  }
  state.counters["points"] = static_cast<double>(map.size());
}
BENCHMARK(check_free_space)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
