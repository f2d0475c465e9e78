// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// A plain reference of VoxelGrid: keeps all points of each voxel and computes means and votes at
/// the end. For tests.
inline PointCloud brute_force_thinning(const PointCloud& points, double voxel_size_m) {
  std::map<std::array<double, 3>, std::vector<std::size_t>> voxels;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<double, 3> key{};
    for (int axis = 0; axis < 3; ++axis) {
      key[static_cast<std::size_t>(axis)] =
          std::floor(static_cast<double>(points.positions[i][axis]) / voxel_size_m);
    }
    voxels[key].push_back(i);
  }
  PointCloud thinned;
  for (const auto& [key, members] : voxels) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d color = Eigen::Vector3d::Zero();
    std::array<int, 256> votes{};
    for (const std::size_t i : members) {
      position += points.positions[i].cast<double>();
      for (int c = 0; c < 3; ++c) color[c] += points.colors[i][static_cast<std::size_t>(c)];
      if (!points.labels.empty()) ++votes[points.labels[i]];
    }
    const auto n = static_cast<double>(members.size());
    thinned.positions.push_back((position / n).cast<float>());
    Rgb rounded{};
    for (int c = 0; c < 3; ++c) {
      rounded[static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::floor(color[c] / n + 0.5));
    }
    thinned.colors.push_back(rounded);
    const auto* winner = std::max_element(votes.begin(), votes.end());  // the first of equals
    thinned.labels.push_back(static_cast<std::uint8_t>(winner - votes.begin()));
  }
  return thinned;
}

/// Uniform in a cube of the given half edge, with random colours and labels 0 ... 3.
inline PointCloud random_cloud(std::size_t n, double half_edge_m, std::uint32_t seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> coordinate(-static_cast<float>(half_edge_m),
                                                   static_cast<float>(half_edge_m));
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const float x = coordinate(rng);
    const float y = coordinate(rng);
    const float z = coordinate(rng);
    cloud.positions.emplace_back(x, y, z);
    const auto byte = [&rng] { return static_cast<std::uint8_t>(rng() % 256); };
    const std::uint8_t red = byte();
    const std::uint8_t green = byte();
    cloud.colors.push_back({red, green, byte()});
    cloud.labels.push_back(static_cast<std::uint8_t>(rng() % 4));
  }
  return cloud;
}

}  // namespace stillmap
