// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "tooling/browser/message.hpp"

namespace stillmap {

/// What moves in a frame, as points.
struct GhostPoints {
  std::vector<std::uint16_t> positions;  ///< camera coordinates, millimetres + 32768
  std::vector<std::uint8_t> colors;      ///< red, green, blue, place in the frame's objects

  [[nodiscard]] std::size_t size() const { return colors.size() / 4; }
  /// Adds a point; its coordinates are kept within +-32 m. `place`: of its object.
  void add(const Eigen::Vector3f& p_camera, const Rgb& color, std::uint8_t place);
};

/// What moved in the frame of a stamp.
struct StampedGhosts {
  Stamp stamp;
  GhostPoints points;
};

/// Attaches the points to a message; the offsets of positions and colours, and the count.
[[nodiscard]] std::array<std::size_t, 3> attach_ghosts(Message& message, const GhostPoints& ghosts);

}  // namespace stillmap
