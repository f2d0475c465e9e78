// SPDX-License-Identifier: Apache-2.0
// A session of 300 key frames with 1000 features each: written, read, and its places indexed anew.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <random>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/slam/map/place_index.hpp"
#include "tests/support/simulated_world.hpp"

namespace stillmap {
namespace {

constexpr int kKeyframes = 300;
constexpr std::size_t kFeatures = 1000;
constexpr std::size_t kObservations = 6;  // of a landmark, at most

Features first_features(Features features) {
  const std::size_t size = std::min(kFeatures, features.size());
  features.raw_px.resize(size);
  features.ideal_px.resize(size);
  features.px.resize(size);
  features.sensor_depth_m.resize(size);
  features.depth_m.resize(size);
  features.level.resize(size);
  features.angle_deg.resize(size);
  features.descriptors.resize(size);
  features.grid = FeatureGrid(features.px, 640, 480);
  return features;
}

// A camera that turns in a box; all features see landmarks, with 8 bits flipped.
Map make_map() {
  SimulatedWorld::Config config;
  config.points = 14000;
  const SimulatedWorld world(config, simulated_camera());
  std::mt19937 rng(1);
  Map map(world.level_scales());
  std::map<std::uint32_t, LandmarkId> landmarks;
  for (int k = 0; k < kKeyframes; ++k) {
    const double angle = 0.1 * k;
    const Eigen::Isometry3d T =
        make_pose(so3_exp({0, angle, 0}), {0.3 * std::cos(angle), 0, 0.3 * std::sin(angle)});
    Observed observed = world.observe(T, {.flipped_bits = 8}, rng);
    Keyframe keyframe;
    keyframe.stamp = {k * 0.5, std::to_string(k)};
    keyframe.T_world_camera = T;
    keyframe.features =
        std::make_shared<const Features>(first_features(std::move(observed.features)));
    const std::uint32_t size = static_cast<std::uint32_t>(keyframe.features->size());
    const KeyframeId id = map.add_keyframe(std::move(keyframe));
    for (std::uint32_t i = 0; i < size; ++i) {
      LandmarkId& known = landmarks[observed.points[i]];
      if (known.valid() && map.landmark(known).observations.size() < kObservations) {
        map.add_observation(known, {id, i});
        map.refresh(known);
      } else {
        known = map.add_landmark(world.points()[observed.points[i]].position, {id, i});
      }
    }
  }
  return map;
}

// About as many points as the views of fr3 have.
std::shared_ptr<const StaticView> make_view() {
  StaticView view;
  view.cloud.origin = {-1, -1, 0.5F};
  view.cloud.step = {1e-4F, 1e-4F, 1e-4F};
  view.cloud.places.assign(19000, {11000, 12000, 10000});
  view.cloud.colors.assign(19000, Rgb{1, 2, 3});
  view.range = {2, 320, 240, std::vector<RangeCell>(std::size_t{320} * 240, {1.5F, false})};
  return std::make_shared<const StaticView>(std::move(view));
}

Session make_session() {
  Session session{simulated_camera(), "", make_map(), {}, {}, {}};
  const std::shared_ptr<const StaticView> view = make_view();
  for (std::uint32_t k = 0; k < kKeyframes; ++k) {
    for (std::uint32_t i = 0; i < 10; ++i) {
      session.frames.push_back({{k * 0.5 + i * 0.03, "0.5"}, KeyframeId(k)});
    }
    session.views.push_back({10 * k, view});
  }
  return session;
}

// A file in a temporary folder, removed with the object.
struct SessionFile {
  SessionFile() : session(make_session()) {
    std::filesystem::create_directories(folder);
    write_session(path, session);
  }
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;
  ~SessionFile() { std::filesystem::remove_all(folder); }

  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("session_bench" + std::to_string(::getpid()));
  std::filesystem::path path = folder / "map.stillmap";
  Session session;
};

const SessionFile& session_file() {
  static const SessionFile file;
  return file;
}

void count(benchmark::State& state, const std::filesystem::path& path) {
  const Session session = read_session(path);
  state.counters["landmarks"] = static_cast<double>(session.map.landmark_count());
  state.counters["features"] =
      static_cast<double>(session.map.keyframe(KeyframeId(kKeyframes / 2)).features->size());
  state.counters["MB"] = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
}

void write_whole(benchmark::State& state) {
  const SessionFile& file = session_file();
  for (auto iteration : state) write_session(file.path, file.session);
  count(state, file.path);
}

void write_without_views(benchmark::State& state) {
  const SessionFile& file = session_file();
  const std::filesystem::path path = file.folder / "small.stillmap";
  const Session session = read_session(file.path, {.with_views = false});
  for (auto iteration : state) write_session(path, session);
  count(state, path);
}

void read_without_views(benchmark::State& state) {
  const SessionFile& file = session_file();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(read_session(file.path, {.with_views = false}));
  }
}

void read_whole(benchmark::State& state) {
  const SessionFile& file = session_file();
  for (auto iteration : state) benchmark::DoNotOptimize(read_session(file.path));
}

void index_places(benchmark::State& state) {
  const SessionFile& file = session_file();
  for (auto iteration : state) benchmark::DoNotOptimize(index_of(file.session.map));
}

BENCHMARK(write_whole)->Unit(benchmark::kMillisecond);
BENCHMARK(write_without_views)->Unit(benchmark::kMillisecond);
BENCHMARK(read_whole)->Unit(benchmark::kMillisecond);
BENCHMARK(read_without_views)->Unit(benchmark::kMillisecond);
BENCHMARK(index_places)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
