// SPDX-License-Identifier: Apache-2.0
// From files to a frame and its detections.
#include <benchmark/benchmark.h>

#include "bench/rendered_office.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"

namespace stillmap {
namespace {

/// The folder of the frames' files. The first call renders them, so it precedes the measured loop.
std::vector<SequenceEntry> entries() {
  std::vector<SequenceEntry> entries;
  for (std::uint32_t k = 0; k < RenderedOffice::kFrames; ++k) {
    entries.push_back(office().sequence().entry(FrameId(k)));
  }
  return entries;
}

void read_color_png(benchmark::State& state) {
  const std::vector<SequenceEntry> files = entries();
  std::size_t k = 0;
  for (auto iteration : state) {
    benchmark::DoNotOptimize(read_color(files[k++ % files.size()].color_file).mat.data);
  }
}

void decode_color_jpeg(benchmark::State& state) {
  const std::vector<std::uint8_t> file = encode_jpeg(office().frame(0)->color, 95);
  const std::string bytes(file.begin(), file.end());
  for (auto iteration : state) {
    benchmark::DoNotOptimize(decode_color(bytes, "frame.jpg").mat.data);
  }
}

void read_depth_png(benchmark::State& state) {
  const double factor = office().camera().depth_factor;
  const std::vector<SequenceEntry> files = entries();
  std::size_t k = 0;
  for (auto iteration : state) {
    benchmark::DoNotOptimize(read_depth(files[k++ % files.size()].depth_file, factor).mat.data);
  }
}

void color_to_gray(benchmark::State& state) {
  const FramePtr frame = office().frame(0);
  for (auto iteration : state) benchmark::DoNotOptimize(to_gray(frame->color).mat.data);
}

void read_detections(benchmark::State& state) {
  const std::vector<SequenceEntry> files = entries();
  std::size_t k = 0, objects = 0;
  for (auto iteration : state) {
    objects += office().detections().at(files[k++ % files.size()].stamp).objects.size();
  }
  state.counters["objects"] = static_cast<double>(objects) / static_cast<double>(k);
}

/// Tracks, and missed objects filled in from up to three frames before and after.
void fill_objects(benchmark::State& state) {
  (void)office();  // rendered before the measured loop
  ObjectTracker tracker({}, FillRule::kBothWays);
  std::uint32_t step = 0;
  std::size_t filled = 0;
  for (auto iteration : state) {
    const std::optional<FrameObjects> objects =
        tracker.push({FrameId(step), office().found(step), office().frame(step)->depth});
    ++step;
    if (!objects) continue;
    for (const TrackedObject& object : objects->objects) filled += object.filled ? 1 : 0;
  }
  state.counters["filled"] = static_cast<double>(filled) / static_cast<double>(step);
}

BENCHMARK(read_color_png)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_color_jpeg)->Unit(benchmark::kMillisecond);
BENCHMARK(read_depth_png)->Unit(benchmark::kMillisecond);
BENCHMARK(color_to_gray)->Unit(benchmark::kMillisecond);
BENCHMARK(read_detections)->Unit(benchmark::kMillisecond);
BENCHMARK(fill_objects)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
