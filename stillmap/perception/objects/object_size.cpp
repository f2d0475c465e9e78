// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_size.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace stillmap {
namespace {

// Width times height of a large object. A person of 2 m with both arms held out covers 1.1 m^2.
constexpr std::array<std::pair<std::string_view, double>, 17> kLargest_m2 = {{
    {"airplane", 1000},
    {"bed", 5},
    {"bicycle", 2},
    {"boat", 1000},
    {"bus", 50},
    {"car", 12},
    {"chair", 1.2},
    {"couch", 4},
    {"cow", 5},
    {"dining table", 5},
    {"elephant", 20},
    {"giraffe", 12},
    {"horse", 6},
    {"motorcycle", 3},
    {"person", 1.5},
    {"train", 1000},
    {"truck", 50},
}};
constexpr double kLargestOther_m2 = 1.5;

}  // namespace

double largest_silhouette_m2(std::string_view class_name) {
  const auto* const known =
      std::ranges::find(kLargest_m2, class_name, &std::pair<std::string_view, double>::first);
  return known != kLargest_m2.end() ? known->second : kLargestOther_m2;
}

double silhouette_m2(const PixelPatch& patch, const DepthImage& depth, const CameraModel& camera) {
  int pixels = 0, measured = 0;
  double squared_depths = 0;
  for (int v = 0; v < patch.area.height; v += 2) {
    const std::uint8_t* pixel = patch.pixels[v];
    const float* z = depth.mat[patch.area.y + v] + patch.area.x;
    for (int u = 0; u < patch.area.width; u += 2) {
      if (pixel[u] == 0) continue;
      ++pixels;
      if (!(z[u] > 0)) continue;
      ++measured;
      squared_depths += static_cast<double>(z[u]) * static_cast<double>(z[u]);
    }
  }
  if (measured == 0) return 0;
  return 4.0 * pixels * squared_depths / measured / (camera.fx * camera.fy);
}

}  // namespace stillmap
