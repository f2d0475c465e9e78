// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/depth_stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace stillmap {
namespace {

constexpr double kMadToSigma = 1.4826;
// Depth is quantised, so most blocks of a wall may have exactly the same spread.
constexpr double kLeastMad = 1e-6;

double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Standard deviation of the 3x3 pixels around one; nothing where one of them has no depth.
std::optional<double> block_spread(const cv::Mat1f& depth,
                                   const Eigen::Vector2f& px,
                                   bool relative) {
  if (!px.allFinite()) return std::nullopt;
  const long u = std::lround(px.x()), v = std::lround(px.y());
  if (u < 1 || v < 1 || u + 1 >= depth.cols || v + 1 >= depth.rows) return std::nullopt;
  double sum = 0, squares = 0;
  const auto centre = static_cast<double>(depth(static_cast<int>(v), static_cast<int>(u)));
  for (int row = static_cast<int>(v) - 1; row <= v + 1; ++row) {
    for (int x = static_cast<int>(u) - 1; x <= u + 1; ++x) {
      const auto z = static_cast<double>(depth(row, x));
      if (!(z > 0) || !std::isfinite(z)) return std::nullopt;
      sum += z - centre;
      squares += (z - centre) * (z - centre);
    }
  }
  const double variance = std::max(0.0, squares / 9 - sum * sum / 81);
  return std::sqrt(variance) / (relative ? centre * centre : 1.0);
}

}  // namespace

std::vector<DepthStability> judge_depth_stability(const DepthImage& depth,
                                                  std::span<const Eigen::Vector2f> raw_px,
                                                  const DepthStabilityConfig& config) {
  std::vector<DepthStability> result(raw_px.size(), DepthStability::kMissing);
  std::vector<std::size_t> measured;
  std::vector<double> spreads;
  for (std::size_t i = 0; i < raw_px.size(); ++i) {
    const std::optional<double> spread = block_spread(depth.mat, raw_px[i], config.relative);
    if (!spread) continue;
    measured.push_back(i);
    spreads.push_back(*spread);
  }
  if (spreads.empty()) return result;
  const double middle = upper_median(spreads);
  std::vector<double> distances = spreads;
  for (double& d : distances) d = std::abs(d - middle);
  const double bound =
      config.mad_factor * kMadToSigma * std::max(upper_median(distances), kLeastMad);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    result[measured[k]] =
        std::abs(spreads[k] - middle) > bound ? DepthStability::kUnstable : DepthStability::kStable;
  }
  return result;
}

}  // namespace stillmap
