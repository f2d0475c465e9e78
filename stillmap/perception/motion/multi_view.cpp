// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/multi_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

/// The pixel at which a point is seen, with its 3 x 3 neighbours in the image; nothing elsewhere.
std::optional<cv::Point> inner_pixel(const CameraModel& camera, const Eigen::Vector3d& p) {
  if (!(p.z() > 0)) return std::nullopt;
  const Eigen::Vector2d raw = camera.distort(camera.project(p));
  if (!raw.allFinite()) return std::nullopt;
  const bool inside = raw.x() >= 1 && raw.y() >= 1 && raw.x() < camera.width_px - 2 &&
                      raw.y() < camera.height_px - 2;
  if (!inside) return std::nullopt;
  return cv::Point(cvRound(raw.x()), cvRound(raw.y()));
}

/// Whether depth is known around the pixel and varies little.
bool is_smooth(const cv::Mat1f& depth, const cv::Point& px, double most) {
  double least = 0, greatest = 0;
  cv::minMaxLoc(depth(cv::Rect(px.x - 1, px.y - 1, 3, 3)), &least, &greatest);
  return least > 0 && greatest - least <= most;
}

/// The cosine of the angle at a point between the rays to both cameras.
double cos_parallax(const Eigen::Vector3d& p_current, const Eigen::Vector3d& view_in_current) {
  return p_current.normalized().dot((p_current - view_in_current).normalized());
}

}  // namespace

JumpImage hiding_objects(const DepthImage& current,
                         std::span<const PointView> views,
                         const CameraModel& camera,
                         const MultiViewConfig& config) {
  cv::Mat1f depth = current.mat;  // flood fill changes the mask alone
  cv::Mat1b grown(depth.rows + 2, depth.cols + 2, std::uint8_t{0});  // with a rim, for flood fill
  const double least_cos = std::cos(config.max_parallax_deg * std::numbers::pi / 180);
  for (const PointView& view : views) {
    const Eigen::Vector3d centre = view.T_current_view.translation();
    for (const Eigen::Vector3d& p_view : view.points) {
      const Eigen::Vector3d p = view.T_current_view * p_view;
      const std::optional<cv::Point> px = inner_pixel(camera, p);
      if (!px || grown(*px + cv::Point(1, 1)) != 0) continue;
      if (cos_parallax(p, centre) < least_cos || !is_smooth(depth, *px, config.grow_m)) continue;
      if (!(p.z() - static_cast<double>(depth(*px)) > config.nearer_m)) continue;
      constexpr int kFlags =
          4 | (kCameNearer << 8) | cv::FLOODFILL_FIXED_RANGE | cv::FLOODFILL_MASK_ONLY;
      cv::floodFill(depth, grown, *px, {}, nullptr, config.grow_m, config.grow_m, kFlags);
    }
  }
  return JumpImage(grown(cv::Rect(1, 1, depth.cols, depth.rows)).clone());
}

}  // namespace stillmap
