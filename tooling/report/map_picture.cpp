// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr int kLargestSplat_px = 48;  // a point very close to the camera must not hide everything

struct Rendering {
  cv::Mat3b color;
  cv::Mat1f depth;
};

int splat_side_px(const View& view, double depth) {
  const double side = view.point_size_m * view.scale / (view.orthographic ? 1.0 : depth);
  return static_cast<int>(std::lround(std::clamp<double>(side, 1, kLargestSplat_px)));
}

void splat(Rendering& rendering, const Eigen::Vector3d& px, int side, const Rgb& color) {
  const double limit = kLargestSplat_px;
  if (px.x() < -limit || px.y() < -limit) return;
  if (px.x() > rendering.color.cols + limit || px.y() > rendering.color.rows + limit) return;
  const int x = static_cast<int>(std::floor(px.x() - 0.5 * (side - 1)));
  const int y = static_cast<int>(std::floor(px.y() - 0.5 * (side - 1)));
  const cv::Rect square =
      cv::Rect(x, y, side, side) & cv::Rect(0, 0, rendering.color.cols, rendering.color.rows);
  const float depth = static_cast<float>(px.z());
  for (int v = square.y; v < square.y + square.height; ++v) {
    for (int u = square.x; u < square.x + square.width; ++u) {
      if (depth >= rendering.depth(v, u)) continue;
      rendering.depth(v, u) = depth;
      rendering.color(v, u) = {color[0], color[1], color[2]};
    }
  }
}

// Twice the signed area of the triangle a, b, p.
double area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// A projected corner of a triangle.
struct Corner {
  Eigen::Vector3d px;  ///< as project_point() gives it
  Rgb color;
};

// Of the pixels whose centres the triangle covers. In perspective the inverse depth is linear in
// the picture; colours are taken for linear, for triangles are small.
void fill(Rendering& rendering, const std::array<Corner, 3>& corners, bool orthographic) {
  const auto& [a, b, c] = corners;
  const double whole = area(a.px, b.px, c.px.head<2>());
  const Eigen::Vector2d low = a.px.cwiseMin(b.px).cwiseMin(c.px).head<2>().cwiseMax(0);
  const Eigen::Vector2d high = a.px.cwiseMax(b.px).cwiseMax(c.px).head<2>().cwiseMin(
      Eigen::Vector2d(rendering.color.cols, rendering.color.rows));
  if (whole == 0 || (high.array() <= low.array()).any()) return;
  for (int v = static_cast<int>(low.y()); v < high.y(); ++v) {
    for (int u = static_cast<int>(low.x()); u < high.x(); ++u) {
      const Eigen::Vector2d at(u + 0.5, v + 0.5);
      const Eigen::Vector3d weights =
          Eigen::Vector3d(area(b.px, c.px, at), area(c.px, a.px, at), area(a.px, b.px, at)) / whole;
      if (weights.minCoeff() < 0) continue;
      const Eigen::Vector3d depths(a.px.z(), b.px.z(), c.px.z());
      const double depth =
          orthographic ? weights.dot(depths) : 1 / weights.dot(depths.cwiseInverse());
      if (static_cast<float>(depth) >= rendering.depth(v, u)) continue;
      rendering.depth(v, u) = static_cast<float>(depth);
      for (int i = 0; i < 3; ++i) {
        const auto channel = static_cast<std::size_t>(i);
        rendering.color(v, u)[i] = cv::saturate_cast<std::uint8_t>(
            weights.dot(Eigen::Vector3d(a.color[channel], b.color[channel], c.color[channel])));
      }
    }
  }
}

// Eye-dome lighting (Boucheny 2009): a pixel darkens by its distance behind its neighbours. This
// shows the shape of points without normals. Steps are relative to the distance in perspective.
cv::Mat1f dome_shade(const cv::Mat1f& depth, bool orthographic) {
  constexpr std::array<std::array<int, 2>, 8> kNeighbours = {
      {{-2, 0}, {2, 0}, {0, -2}, {0, 2}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
  constexpr float kStrength = 2.0F;
  cv::Mat1f level(depth.size());
  std::transform(depth.begin(), depth.end(), level.begin(), [orthographic](float d) {
    return orthographic || d == kNothing ? d : 4.0F * std::log(d);
  });
  cv::Mat1f shade(depth.size(), 1.0F);
  for (int v = 2; v < depth.rows - 2; ++v) {
    for (int u = 2; u < depth.cols - 2; ++u) {
      if (level(v, u) == kNothing) continue;
      float behind = 0;
      for (const std::array<int, 2>& n : kNeighbours) {
        behind += std::clamp(level(v, u) - level(v + n[1], u + n[0]), 0.0F, 0.5F);
      }
      shade(v, u) = std::exp(-kStrength * behind / static_cast<float>(kNeighbours.size()));
    }
  }
  return shade;
}

Rendering nothing_drawn(const PointCloud& cloud, const View& view) {
  STILLMAP_CHECK(cloud.colors.size() == cloud.size() && view.width_px > 0 && view.height_px > 0);
  const Rgb& back = view.background;
  return {cv::Mat3b(view.height_px, view.width_px, {back[0], back[1], back[2]}),
          cv::Mat1f(view.height_px, view.width_px, kNothing)};
}

ColorImage finished(Rendering rendering, const View& view) {
  if (view.shade_depth_steps) {
    const cv::Mat1f shade = dome_shade(rendering.depth, view.orthographic);
    std::transform(rendering.color.begin(),
                   rendering.color.end(),
                   shade.begin(),
                   rendering.color.begin(),
                   [](const cv::Vec3b& c, float s) { return cv::Vec3b(cv::Vec3f(c) * s); });
  }
  return ColorImage(rendering.color);
}

}  // namespace

Eigen::Isometry3d look_at(const Eigen::Vector3d& eye,
                          const Eigen::Vector3d& target,
                          const Eigen::Vector3d& down) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = down.cross(forward).normalized();
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << right, forward.cross(right), forward;
  T_world_camera.translation() = eye;
  return T_world_camera.inverse();
}

std::optional<Eigen::Vector3d> project_point(const View& view, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = view.T_camera_world * p_world;
  if (!p.allFinite() || p.z() < view.near_m) return std::nullopt;
  const double scale = view.orthographic ? view.scale : view.scale / p.z();
  return Eigen::Vector3d(
      scale * p.x() + 0.5 * view.width_px, scale * p.y() + 0.5 * view.height_px, p.z());
}

ColorImage render_points(const PointCloud& cloud, const View& view) {
  Rendering rendering = nothing_drawn(cloud, view);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::optional<Eigen::Vector3d> px =
        project_point(view, cloud.positions[i].cast<double>());
    if (px) splat(rendering, *px, splat_side_px(view, px->z()), cloud.colors[i]);
  }
  return finished(std::move(rendering), view);
}

ColorImage render_triangles(const PointCloud& vertices, Triangles triangles, const View& view) {
  Rendering rendering = nothing_drawn(vertices, view);
  for (const std::array<std::uint32_t, 3>& triangle : triangles) {
    std::array<Corner, 3> corners;
    bool is_in_view = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t vertex = triangle[i];
      STILLMAP_CHECK(vertex < vertices.size());
      const auto px = project_point(view, vertices.positions[vertex].cast<double>());
      is_in_view = is_in_view && px;
      corners[i] = {px.value_or(Eigen::Vector3d::Zero()), vertices.colors[vertex]};
    }
    if (is_in_view) fill(rendering, corners, view.orthographic);
  }
  return finished(std::move(rendering), view);
}

std::vector<std::vector<Eigen::Vector3d>> continuous_parts(const Trajectory& poses) {
  constexpr double kGap_s = 0.5;
  std::vector<std::vector<Eigen::Vector3d>> parts;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i == 0 || poses[i].stamp.seconds - poses[i - 1].stamp.seconds > kGap_s)
      parts.emplace_back();
    parts.back().push_back(poses[i].T_world_camera.translation());
  }
  return parts;
}

ColorImage draw_path(const ColorImage& picture,
                     const View& view,
                     std::span<const Eigen::Vector3d> path_world,
                     Rgb color) {
  constexpr double kFarOutside_px = 20000;  // beyond it OpenCV's fixed-point coordinates overflow
  constexpr int kShift = 4;                 // of those coordinates: sixteenths of a pixel
  cv::Mat3b drawn = picture.mat.clone();
  std::vector<cv::Point> line;
  const auto draw_and_clear = [&] {
    cv::polylines(drawn,
                  line,
                  false,
                  {double(color[0]), double(color[1]), double(color[2])},
                  2,
                  cv::LINE_AA,
                  kShift);
    line.clear();
  };
  for (const Eigen::Vector3d& p_world : path_world) {
    const std::optional<Eigen::Vector3d> px = project_point(view, p_world);
    if (px && px->head<2>().cwiseAbs().maxCoeff() < kFarOutside_px) {
      line.emplace_back(cvRound(px->x() * 16), cvRound(px->y() * 16));
    } else if (!line.empty()) {
      draw_and_clear();
    }
  }
  if (!line.empty()) draw_and_clear();
  return ColorImage(drawn);
}

}  // namespace stillmap
