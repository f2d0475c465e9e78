// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "stillmap/io/image_io.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

// A slope with a camera's noise.
std::string noisy_color() {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, 3.0);
  cv::Mat3b rgb(480, 640);
  for (int v = 0; v < rgb.rows; ++v) {
    for (int u = 0; u < rgb.cols; ++u) {
      for (int c = 0; c < 3; ++c) {
        rgb(v, u)[c] = cv::saturate_cast<std::uint8_t>(60 + u / 8 + v / 8 + noise(rng));
      }
    }
  }
  return encode_png(ColorImage(rgb));
}

// A wall with a sensor's steps.
std::string stepped_depth() {
  std::mt19937 rng(2);
  cv::Mat1w raw(480, 640);
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u) {
      raw(v, u) = static_cast<std::uint16_t>(10000 + (u / 40 + rng() % 3) * 35);
    }
  }
  return encode_png_bytes(raw);
}

void decode_color_png(benchmark::State& state) {
  const std::string png = noisy_color();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(decode_png(png, PngKind::kRgb8, "bench"));
  }
}

void decode_color_by_libpng(benchmark::State& state) {
  const std::string png = noisy_color();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(decode_by_libpng(png, PngKind::kRgb8, "bench"));
  }
}

void decode_depth_png(benchmark::State& state) {
  const std::string png = stepped_depth();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(decode_png(png, PngKind::kGray16, "bench"));
  }
}

void decode_depth_by_libpng(benchmark::State& state) {
  const std::string png = stepped_depth();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(decode_by_libpng(png, PngKind::kGray16, "bench"));
  }
}

BENCHMARK(decode_color_png)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_color_by_libpng)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_depth_png)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_depth_by_libpng)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
