// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/optim/pose_graph.hpp"

namespace stillmap {
namespace {

// Key frames on a circle, each connected to the five before it; one loop removes a drift of 0.5 m.
void close_circle(benchmark::State& state) {
  const auto count = static_cast<std::uint32_t>(state.range(0));
  PoseGraph graph;
  std::vector<Eigen::Isometry3d> truth;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    truth.push_back(make_pose(so3_exp(Eigen::Vector3d(0, angle, 0)),
                              3.0 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle))));
    Eigen::Isometry3d drifted = truth.back();
    drifted.translation() *= 1.0 + 0.16 * k / count;
    graph.T_world.push_back(drifted);
    graph.held.push_back(k == 0 ? 1 : 0);
    for (std::uint32_t back = 1; back <= std::min(k, 5U); ++back) {
      graph.edges.push_back({k - back,
                             k,
                             graph.T_world[k - back].inverse() * drifted,
                             0.01 * std::sqrt(back),
                             0.005 * std::sqrt(back)});
    }
  }
  graph.edges.push_back({0, count - 1, truth.front().inverse() * truth.back(), 0.005, 0.002});
  for (auto iteration : state) benchmark::DoNotOptimize(optimize_pose_graph(graph, {}));
}

BENCHMARK(close_circle)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
