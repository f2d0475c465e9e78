// SPDX-License-Identifier: Apache-2.0
// The view of a frame, and the map of all views, with the settings of a run.
#include <benchmark/benchmark.h>

#include "bench/rendered_office.hpp"
#include "stillmap/dense/static_map.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

/// People are not static.
DynamicRegions people(std::uint32_t step) {
  cv::Mat1b mask(office().camera().height_px, office().camera().width_px, std::uint8_t{0});
  const FrameDetections found = office().found(step);
  for (const DetectedObject& object : found.objects) {
    if (object.class_name == "person") mask.setTo(1, found.mask.mat == object.id);
  }
  return {Mask(mask), Mask(mask)};
}

void keep_view(benchmark::State& state) {
  const CloudConfig config = CloudConfig{}.resolved_for(dynamics_mode("full").cloud);
  const cv::Mat2f rays = pixel_rays(office().camera());
  const FramePtr frame = office().frame(0);
  const DynamicRegions masks = people(0);
  StaticView view;
  for (auto iteration : state) view = static_view(*frame, rays, config, masks, {});
  state.counters["points"] = static_cast<double>(view.cloud.size());
  state.counters["kilobytes"] =
      1e-3 * static_cast<double>(view.cloud.size() *
                                     (sizeof(view.cloud.places[0]) + sizeof(view.cloud.colors[0])) +
                                 view.range.cells.size() * sizeof(RangeCell));
}

/// Repeated views of one place: as many as a run keeps there in 4 s and in 20 s.
void assemble_static_map(benchmark::State& state) {
  const CloudConfig config = CloudConfig{}.resolved_for(dynamics_mode("full").cloud);
  const cv::Mat2f rays = pixel_rays(office().camera());
  std::vector<StaticView> views;
  for (std::uint32_t k = 0; k < RenderedOffice::kFrames; ++k) {
    views.push_back(static_view(*office().frame(k), rays, config, people(k), {}));
  }
  std::vector<PosedView> posed;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(state.range(0)); ++i) {
    posed.push_back({office().T_world_camera(i), &views[RenderedOffice::at_step(i)]});
  }
  std::size_t points = 0;
  const auto threads = static_cast<std::size_t>(state.range(1));
  for (auto iteration : state)
    points = static_map(posed, office().camera(), config, threads).size();
  state.counters["points"] = static_cast<double>(points);
}

BENCHMARK(keep_view)->Unit(benchmark::kMillisecond);
BENCHMARK(assemble_static_map)
    ->ArgNames({"views", "threads"})
    ->ArgsProduct({{20, 100}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
