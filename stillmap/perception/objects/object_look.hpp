// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/object_state.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

/// The colors of an object: the share of its pixels in each of 4 x 4 x 4 cells of the color cube.
using ColorShares = std::array<float, 64>;

/// The Hellinger distance of two distributions of colors: 0 for equal ones, 1 without a common
/// color.
[[nodiscard]] double color_distance(const ColorShares& a, const ColorShares& b);

/// Calls `use(row, column, depth)` for some 300 pixels of an object with depths in an interval, on
/// a grid over `area`, which bounds its pixels. Returns the distance of the grid's lines, pixels.
template <class Use>
int for_each_sample(const ObjectView& view,
                    const cv::Rect& area,
                    DepthInterval depths,
                    const Use& use) {
  constexpr double kSamples = 300;
  const int step = std::max(1, static_cast<int>(std::sqrt(area.area() / kSamples)));
  for (int row = area.y + step / 2; row < area.y + area.height; row += step) {
    for (int x = area.x + step / 2; x < area.x + area.width; x += step) {
      const float z = view.depth.mat(row, x);
      if (view.mask.mat(row, x) == view.id && depths.contains(z)) use(row, x, z);
    }
  }
  return step;
}

/// What a frame shows of an object.
struct ObjectLook {
  std::vector<Eigen::Vector3d> surface;  ///< a sample of its visible surface, camera coordinates
  ColorShares colors{};                  ///< of these points; all 0 without a color image
  double area_m2 = 0;                    ///< of its silhouette
};

/// The look of an object, by for_each_sample().
[[nodiscard]] ObjectLook look_of(const RgbdFrame& frame,
                                 const ObjectView& view,
                                 const cv::Rect& area,
                                 DepthInterval depths,
                                 const CameraModel& camera);

/// The point whose coordinates are the medians of those of `points`, which are not empty.
[[nodiscard]] Eigen::Vector3d median_point(const std::vector<Eigen::Vector3d>& points);

/// The distance from a point to the nearest of `points`; infinite without any.
[[nodiscard]] double distance_to(const std::vector<Eigen::Vector3d>& points,
                                 const Eigen::Vector3d& p);

}  // namespace stillmap
