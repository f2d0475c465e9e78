// SPDX-License-Identifier: Apache-2.0
// Tracking and local mapping in a simulated room, without images.
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/mapping/local_mapper.hpp"
#include "stillmap/slam/tracking/tracker.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr int kRound = 200;  // frames until the camera is back at its start
constexpr ObservationNoise kNoise{.pixel_sigma_px = 0.7,
                                  .inverse_depth_sigma = 0.01,
                                  .missing_depth_share = 0.2,
                                  .flipped_bits = 15};

const SimulatedWorld& world() {
  static const SimulatedWorld kWorld({}, simulated_camera());
  return kWorld;
}

MeasurementModel model() {
  return MeasurementModel({.pixel_sigma_px = 0.7, .inverse_depth_sigma = 0.01},
                          world().level_scales());
}

Eigen::Isometry3d pose(int k) {
  const double s = 2 * std::numbers::pi * k / kRound;
  return make_pose(so3_exp(Eigen::Vector3d(0.05 * std::sin(s), 0.4 * std::sin(s), 0)),
                   Eigen::Vector3d(0.6 * std::sin(s), 0.2 * std::sin(2 * s), 0.3 * std::cos(s)));
}

/// Key frames all along the round.
SimulatedMap make_map(int keyframes) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < keyframes; ++i) poses.push_back(pose(i * kRound / keyframes));
  std::mt19937 rng(2);
  return make_true_map(world(), poses, kNoise, rng);
}

RgbdFrame frame_at(int k) {
  RgbdFrame frame;
  frame.id = FrameId(static_cast<std::uint32_t>(k));
  frame.stamp.seconds = k / 30.0;
  return frame;
}

void track_frame(benchmark::State& state) {
  const SimulatedMap simulated = make_map(20);
  std::mt19937 rng(3);
  std::vector<Features> seen;
  for (int k = 0; k < kRound; ++k) seen.push_back(world().observe(pose(k), kNoise, rng).features);
  Tracker tracker({}, {}, world().camera(), model(), 0);
  (void)tracker.start(frame_at(0), simulated.map.keyframe(KeyframeId(0)).features);
  tracker.set_reference(KeyframeId(0), simulated.map);
  const PlaceIndex places;  // not queried while tracking is not lost
  int k = 0;
  int inliers = 0;
  for (auto iteration : state) {
    ++k;
    const std::size_t at = static_cast<std::size_t>(k % kRound);
    const TrackedFrame tracked = tracker.track(frame_at(k), seen[at], simulated.map, places);
    if (!has_pose(tracked)) return state.SkipWithError("tracking was lost");
    inliers = tracked.inliers;
  }
  state.counters["inliers"] = inliers;
}

/// The last key frame is new: up to 20 others are around it, displaced by 1 cm.
SimulatedMap map_with_new_keyframe(int keyframes) {
  SimulatedMap simulated = make_map(keyframes);
  std::mt19937 rng(4);
  std::normal_distribution<double> centimetre(0, 0.01);
  for (int k = 1; k < keyframes; ++k) {
    const KeyframeId id(static_cast<std::uint32_t>(k));
    const Eigen::Vector3d off(centimetre(rng), centimetre(rng), centimetre(rng));
    simulated.map.set_pose(id, pose(k * kRound / keyframes) * make_pose({1, 0, 0, 0}, off));
  }
  (void)simulated.map.take_changes();
  return simulated;
}

void cut_window(benchmark::State& state) {
  const int keyframes = static_cast<int>(state.range(0));
  const SimulatedMap simulated = map_with_new_keyframe(keyframes);
  const KeyframeId newest(static_cast<std::uint32_t>(keyframes - 1));
  std::size_t in_window = 0;
  for (auto iteration : state) {
    in_window = simulated.map.window(mapping_core(simulated.map, newest, {})).keyframes().size();
  }
  state.counters["keyframes"] = static_cast<double>(in_window);
}

/// All mapping work for a new key frame, in a room already seen by others.
void map_keyframe(benchmark::State& state) {
  const int keyframes = static_cast<int>(state.range(0));
  const SimulatedMap simulated = map_with_new_keyframe(keyframes);
  const KeyframeId newest(static_cast<std::uint32_t>(keyframes - 1));
  const std::vector<KeyframeId> core = mapping_core(simulated.map, newest, {});
  const Map window = simulated.map.window(core);
  for (auto iteration : state) {
    benchmark::DoNotOptimize(map_locally(window, core, world().camera(), {}, model(), {}));
  }
  state.counters["landmarks"] = static_cast<double>(window.landmark_count());
}

BENCHMARK(track_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(cut_window)->Arg(20)->Arg(80)->Unit(benchmark::kMillisecond);
BENCHMARK(map_keyframe)->Arg(20)->Arg(80)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
