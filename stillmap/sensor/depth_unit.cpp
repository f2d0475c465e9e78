// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/depth_unit.hpp"

#include <vector>

namespace stillmap {
namespace {

constexpr std::size_t kValues = std::size_t{1} << 16U;
constexpr std::size_t kEnoughPixels = 1000;

// The value that a share of all are not above.
double quantile(const std::vector<std::size_t>& histogram, std::size_t total, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(total));
  std::size_t below = 0, value = 0;
  while (value + 1 < histogram.size() && below + histogram[value] <= rank) {
    below += histogram[value++];
  }
  return static_cast<double>(value);
}

}  // namespace

std::optional<double> DepthUnitEvidence::depth_factor() const {
  if (pixels < kEnoughPixels) return std::nullopt;
  constexpr double kMillimetres = 1000, kOfTum = 5000;
  const bool millimetres =
      near >= 0.1 * kMillimetres && median <= 6 * kMillimetres && far <= 12 * kMillimetres;
  const bool of_tum = near >= 0.4 * kOfTum;
  if (millimetres && of_tum) return in_fives ? std::optional(kOfTum) : std::nullopt;
  if (millimetres) return kMillimetres;
  if (of_tum) return kOfTum;
  return std::nullopt;
}

DepthUnitEvidence depth_unit_evidence(std::span<const DepthImage> stored) {
  std::vector<std::size_t> histogram(kValues, 0);
  for (const DepthImage& image : stored) {
    for (const float value : image.mat) {
      const bool known = value >= 1.0F && value < static_cast<float>(kValues);
      if (known) ++histogram[static_cast<std::size_t>(value)];
    }
  }
  DepthUnitEvidence evidence;
  std::size_t others = 0;
  for (std::size_t value = 0; value < kValues; ++value) {
    evidence.pixels += histogram[value];
    if (value % 5 != 0) others += histogram[value];
  }
  if (evidence.pixels == 0) return evidence;
  evidence.near = quantile(histogram, evidence.pixels, 0.02);
  evidence.median = quantile(histogram, evidence.pixels, 0.5);
  evidence.far = quantile(histogram, evidence.pixels, 0.98);
  evidence.in_fives = 1000 * others <= evidence.pixels;
  return evidence;
}

}  // namespace stillmap
