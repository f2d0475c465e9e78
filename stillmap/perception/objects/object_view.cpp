// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

// Branch-free, so that it vectorises.
void paint(ObjectMask& mask, const PixelPatch& patch, std::uint8_t id) {
  for (int v = 0; v < patch.area.height; ++v) {
    const std::uint8_t* pixel = patch.pixels[v];
    std::uint8_t* target = mask.mat[patch.area.y + v] + patch.area.x;
    for (int u = 0; u < patch.area.width; ++u) {
      const bool free = (target[u] == 0) & (pixel[u] != 0);
      target[u] = static_cast<std::uint8_t>(target[u] | (free ? id : 0));
    }
  }
}

}  // namespace stillmap
