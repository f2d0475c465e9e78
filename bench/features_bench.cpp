// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "stillmap/slam/features/brief.hpp"
#include "stillmap/slam/features/fast_corners.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"
#include "stillmap/slam/features/patch_blur.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

struct Scene {
  CameraModel camera = builtin_camera("tum_fr1");
  GrayImage image = textured_image(640, 480, 1);
  DepthImage depth{cv::Mat1f(480, 640, 2.0F)};
  OrbExtractor extractor{OrbConfig{}, camera};
};

void extract(benchmark::State& state) {
  Scene scene;
  std::size_t found = 0;
  for (auto iteration : state) {
    const Features features = scene.extractor.extract(scene.image, scene.depth);
    found = features.size();
  }
  state.counters["features"] = static_cast<double>(found);
}

// The part of extraction that needs only the image.
void corners(benchmark::State& state) {
  const Scene scene;
  for (auto iteration : state) {
    benchmark::DoNotOptimize(scene.extractor.corners(scene.image));
  }
}

void scores_of_corners(benchmark::State& state) {
  const Scene scene;
  for (auto iteration : state) benchmark::DoNotOptimize(corner_scores(scene.image.mat));
}

void blur(benchmark::State& state) {
  const Scene scene;
  for (auto iteration : state) {
    benchmark::DoNotOptimize(blurred_for_descriptors(scene.image.mat));
  }
}

void orientation_and_descriptor(benchmark::State& state) {
  const Scene scene;
  TestDice dice(2);
  std::vector<cv::Point> places;
  for (int i = 0; i < 1000; ++i) places.emplace_back(dice.integer(20, 620), dice.integer(20, 460));
  for (auto iteration : state) {
    for (const cv::Point& at : places) {
      const float angle_deg = patch_orientation_deg(scene.image.mat, at);
      benchmark::DoNotOptimize(rotated_brief(scene.image.mat, at, angle_deg));
    }
  }
  state.counters["features"] = static_cast<double>(places.size());
}

// The frame's features, some pixels off and with some bits changed, like projected landmarks.
void match_1500_projections(benchmark::State& state) {
  Scene scene;
  const Features features = scene.extractor.extract(scene.image, scene.depth);
  TestDice dice(3);
  std::vector<Descriptor> descriptors;
  std::vector<Projection> projections;
  for (std::uint32_t i = 0; i < 1500; ++i) {
    const std::size_t f = dice.bits() % features.size();
    descriptors.push_back(dice.flipped(features.descriptors[f], 25));
    const int level = features.level[f];
    const Eigen::Vector2f px = features.px[f] + dice.point(-5, 5, 5);
    projections.push_back({px, 15.0F, 0.5F, 0.2F, std::max(level - 1, 0), level + 1, nullptr});
  }
  for (std::size_t i = 0; i < projections.size(); ++i) projections[i].descriptor = &descriptors[i];
  std::size_t matched = 0;
  for (auto iteration : state) {
    matched = match_projections(projections, features, {}, {.max_distance = 100, .max_ratio = 0.8})
                  .size();
  }
  state.counters["matches"] = static_cast<double>(matched);
}

void match_all_1000_by_1000(benchmark::State& state) {
  Scene scene;
  const Features features = scene.extractor.extract(scene.image, scene.depth);
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < features.size(); ++i) all.push_back(i);
  for (auto iteration : state) {
    benchmark::DoNotOptimize(match_all(features, all, features, {}));
  }
}

BENCHMARK(extract)->Unit(benchmark::kMillisecond);
BENCHMARK(corners)->Unit(benchmark::kMillisecond);
BENCHMARK(scores_of_corners)->Unit(benchmark::kMillisecond);
BENCHMARK(blur)->Unit(benchmark::kMillisecond);
BENCHMARK(orientation_and_descriptor)->Unit(benchmark::kMillisecond);
BENCHMARK(match_1500_projections)->Unit(benchmark::kMillisecond);
BENCHMARK(match_all_1000_by_1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
