// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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
  STILLMAP_CHECK(cloud.colors.size() == cloud.size() && view.width_px > 0 && view.height_px > 0);
  const Rgb& back = view.background;
  Rendering rendering{cv::Mat3b(view.height_px, view.width_px, {back[0], back[1], back[2]}),
                      cv::Mat1f(view.height_px, view.width_px, kNothing)};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::optional<Eigen::Vector3d> px =
        project_point(view, cloud.positions[i].cast<double>());
    if (px) splat(rendering, *px, splat_side_px(view, px->z()), cloud.colors[i]);
  }
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
