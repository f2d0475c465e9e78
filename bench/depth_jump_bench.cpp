// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <benchmark/benchmark.h>

#include "stillmap/perception/motion/depth_jump.hpp"

namespace stillmap {
namespace {

// A wall with a sensor's noise and holes, and an object before it.
DepthImage wall(unsigned seed, int thing_x) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  cv::Mat1f depth(480, 640);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const bool thing = v > 100 && u > thing_x && u < thing_x + 120;
      depth(v, u) = rng() % 20 == 0 ? 0.0F : (thing ? 2.0F : 4.0F) + noise(rng);
    }
  }
  return DepthImage(depth);
}

Eigen::Isometry3d step() {
  return Eigen::Isometry3d(Eigen::Translation3d(0.02, 0.01, -0.01));
}

void warp_depth(benchmark::State& state) {
  const DepthWarper warper(builtin_camera("tum_fr1"));
  const DepthImage before = wall(1, 200);
  for (auto iteration : state) benchmark::DoNotOptimize(warper.warp(before, step()));
}

void find_depth_jumps(benchmark::State& state) {
  const DepthWarper warper(builtin_camera("tum_fr1"));
  const HalfDepth expected = warper.warp(wall(1, 200), step());
  const DepthImage now = wall(2, 230);
  for (auto iteration : state) benchmark::DoNotOptimize(depth_jumps(now, expected, {}));
}

BENCHMARK(warp_depth)->Unit(benchmark::kMillisecond);
BENCHMARK(find_depth_jumps)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
