// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/point_chunks.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {

std::size_t PointChunks::place_of(const std::array<int, 3>& cell) {
  const auto [found, is_new] = places_.try_emplace(cell, chunks_.size());
  if (is_new) chunks_.push_back({.cell = cell, .positions = {}, .colors = {}});
  return found->second;
}

void PointChunks::add(const PointCloud& cloud) {
  constexpr float kFarthest_m = 10'000;
  std::size_t last = chunks_.size();
  for (std::size_t i = 0; i < cloud.size() && points_ < kMostPoints; ++i) {
    const Eigen::Vector3f& p = cloud.positions[i];
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest_m) continue;
    std::array<int, 3> cell{};
    std::array<std::uint16_t, 3> steps{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      const double cells = static_cast<double>(p[axis]) / kSide_m;
      cell[at] = static_cast<int>(std::floor(cells));
      const double rest = (cells - std::floor(cells)) * (kSide_m / kStep_m);
      steps[at] = static_cast<std::uint16_t>(std::min(rest, 65535.0));
    }
    // Most points are in the cube of the point before.
    if (last >= chunks_.size() || chunks_[last].cell != cell) last = place_of(cell);
    PointChunk& chunk = chunks_[last];
    chunk.positions.insert(chunk.positions.end(), steps.begin(), steps.end());
    chunk.colors.insert(chunk.colors.end(), cloud.colors[i].begin(), cloud.colors[i].end());
    ++points_;
  }
}

}  // namespace stillmap
