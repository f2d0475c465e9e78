// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/visible_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tooling/export/view_cone.hpp"

namespace stillmap {
namespace {

constexpr double kCellPx = 4.0;
constexpr double kMaxRadiusPx = 64.0;  // a disc at the lens must not cover the whole image

struct Projected {
  std::uint32_t index = 0;
  Eigen::Vector2d px;
  double depth_m = 0.0;
};

class DepthCells {
 public:
  explicit DepthCells(const Eigen::Vector2d& size_px)
      : columns_(count(size_px.x())),
        rows_(count(size_px.y())),
        nearest_m_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                   std::numeric_limits<float>::infinity()) {}

  void cover(const Eigen::Vector2d& px, double radius_px, double depth_m) {
    const int left = clamp(px.x() - radius_px, columns_);
    const int right = clamp(px.x() + radius_px, columns_);
    const int bottom = clamp(px.y() + radius_px, rows_);
    for (int row = clamp(px.y() - radius_px, rows_); row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        float& nearest = nearest_m_[at(row, column)];
        nearest = std::min(nearest, static_cast<float>(depth_m));
      }
    }
  }

  [[nodiscard]] double nearest(const Eigen::Vector2d& px) const {
    return nearest_m_[at(clamp(px.y(), rows_), clamp(px.x(), columns_))];
  }

 private:
  static int count(double size_px) { return static_cast<int>(std::floor(size_px / kCellPx)) + 1; }
  static int clamp(double px, int cells) {
    return std::clamp(static_cast<int>(std::floor(px / kCellPx)), 0, cells - 1);
  }
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_;
  int rows_;
  std::vector<float> nearest_m_;
};

}  // namespace

std::vector<std::uint32_t> visible_points(std::span<const Eigen::Vector3f> p_world,
                                          const Eigen::Isometry3d& T_world_camera,
                                          const CameraModel& camera,
                                          const VisibilityOptions& options) {
  const ViewCone cone(camera);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  DepthCells cells(cone.size_px());
  std::vector<Projected> inside;
  for (std::size_t i = 0; i < p_world.size(); ++i) {
    const Eigen::Vector3d p_camera = T_camera_world * p_world[i].cast<double>();
    const std::optional<Eigen::Vector2d> px = cone.pixel(p_camera);
    if (!px) continue;
    const double radius_px = options.point_radius_m * camera.fx / p_camera.z();
    inside.push_back({static_cast<std::uint32_t>(i), *px, p_camera.z()});
    cells.cover(*px, std::min(radius_px, kMaxRadiusPx), p_camera.z());
  }
  std::vector<std::uint32_t> seen;
  for (const Projected& point : inside) {
    if (point.depth_m <= cells.nearest(point.px) + options.margin_m) seen.push_back(point.index);
  }
  return seen;
}

}  // namespace stillmap
