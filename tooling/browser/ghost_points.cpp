// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/ghost_points.hpp"

#include <algorithm>

namespace stillmap {

void GhostPoints::add(const Eigen::Vector3f& p_camera, const Rgb& color, std::uint8_t place) {
  for (const float metres : p_camera) {
    const float millimetres = std::clamp(metres * 1000 + 32768, 0.0F, 65535.0F);
    positions.push_back(static_cast<std::uint16_t>(millimetres));
  }
  colors.insert(colors.end(), {color[0], color[1], color[2], place});
}

std::array<std::size_t, 3> attach_ghosts(Message& message, const GhostPoints& ghosts) {
  const std::size_t positions = message.attach(ghosts.positions);
  return {positions, message.attach(ghosts.colors), ghosts.size()};
}

}  // namespace stillmap
