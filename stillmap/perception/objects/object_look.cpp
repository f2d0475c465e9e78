// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace stillmap {
namespace {

std::size_t color_cell(const cv::Vec3b& color) {
  return static_cast<std::size_t>((color[0] / 64) * 16 + (color[1] / 64) * 4 + color[2] / 64);
}

}  // namespace

double color_distance(const ColorShares& a, const ColorShares& b) {
  double common = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    common += std::sqrt(static_cast<double>(a[i]) * static_cast<double>(b[i]));
  }
  return std::sqrt(std::max(0.0, 1.0 - common));
}

ObjectLook look_of(const RgbdFrame& frame,
                   const ObjectView& view,
                   const cv::Rect& area,
                   DepthInterval depths,
                   const CameraModel& camera) {
  ObjectLook look;
  double squared_depths = 0;
  const bool colored = !frame.color.mat.empty();
  const int step = for_each_sample(view, area, depths, [&](int row, int x, float z) {
    const auto depth = static_cast<double>(z);
    look.surface.push_back(camera.unproject(camera.undistort({x, row}), depth));
    if (colored) look.colors[color_cell(frame.color.mat(row, x))] += 1;
    squared_depths += depth * depth;
  });
  for (float& share : look.colors) {
    share /= static_cast<float>(std::max<std::size_t>(look.surface.size(), 1));
  }
  look.area_m2 = step * step * squared_depths / (camera.fx * camera.fy);
  return look;
}

Eigen::Vector3d median_point(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d median;
  std::vector<double> values(points.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(
        points, values.begin(), [axis](const Eigen::Vector3d& p) { return p[axis]; });
    std::ranges::nth_element(values, middle);
    median[axis] = *middle;
  }
  return median;
}

double distance_to(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) least = std::min(least, (point - p).squaredNorm());
  return std::sqrt(least);
}

}  // namespace stillmap
