// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/inpainting.hpp"

#include <optional>

#include <opencv2/core.hpp>

namespace stillmap {
namespace {

/// The pixel of the image at which a point is seen.
std::optional<cv::Point> seen_at(const CameraModel& camera, const Eigen::Vector3d& p) {
  constexpr double kNearest = 0.01;  // metres
  if (!(p.z() > kNearest)) return std::nullopt;
  const Eigen::Vector2d ideal = camera.project(p);
  const Eigen::Vector2d raw = camera.distorted() ? camera.distort(ideal) : ideal;
  const bool inside = raw.x() > -0.5 && raw.y() > -0.5 && raw.x() < camera.width_px - 0.5 &&
                      raw.y() < camera.height_px - 0.5;
  if (!inside) return std::nullopt;
  return cv::Point(cvRound(raw.x()), cvRound(raw.y()));
}

}  // namespace

Inpainter::Inpainter(const CameraModel& camera, std::size_t keyframes)
    : camera_(camera), rays_(pixel_rays(camera)), most_(keyframes) {}

void Inpainter::add_keyframe(const RgbdFrame& frame,
                             const Mask& dynamic,
                             const Eigen::Isometry3d& T_world_camera) {
  keyframes_.push_back({frame.color.mat, frame.depth.mat, dynamic, T_world_camera});
  if (keyframes_.size() > most_) keyframes_.pop_front();
}

InpaintedFrame Inpainter::inpaint(const RgbdFrame& frame,
                                  const Mask& dynamic,
                                  const Eigen::Isometry3d& T_world_camera) const {
  InpaintedFrame result{ColorImage(frame.color.mat.clone()),
                        DepthImage(frame.depth.mat.clone()),
                        Mask(cv::Mat1b(frame.depth.mat.size(), std::uint8_t{0})),
                        1.0};
  const int pixels = dynamic.empty() ? 0 : cv::countNonZero(dynamic.mat);
  if (pixels == 0) return result;
  result.color.mat.setTo(cv::Scalar::all(0), dynamic.mat);
  result.depth.mat.setTo(0, dynamic.mat);
  for (const Keyframe& keyframe : keyframes_) paint(keyframe, dynamic, T_world_camera, result);
  result.filled_share = static_cast<double>(cv::countNonZero(result.filled.mat)) / pixels;
  return result;
}

void Inpainter::paint(const Keyframe& keyframe,
                      const Mask& dynamic,
                      const Eigen::Isometry3d& T_world_camera,
                      InpaintedFrame& onto) const {
  const Eigen::Isometry3d T = T_world_camera.inverse() * keyframe.T_world_camera;
  for (int row = 0; row < rays_.rows; ++row) {
    for (int x = 0; x < rays_.cols; ++x) {
      const auto z = static_cast<double>(keyframe.depth(row, x));
      if (!(z > 0) || keyframe.dynamic.covers(row, x)) continue;
      const cv::Vec2f& ray = rays_(row, x);
      const Eigen::Vector3d p =
          T * Eigen::Vector3d(static_cast<double>(ray[0]) * z, static_cast<double>(ray[1]) * z, z);
      const std::optional<cv::Point> px = seen_at(camera_, p);
      if (!px || !dynamic.covers(px->y, px->x)) continue;
      float& depth = onto.depth.mat(*px);
      if (depth > 0 && static_cast<double>(depth) <= p.z()) continue;
      depth = static_cast<float>(p.z());
      onto.color.mat(*px) = keyframe.color(row, x);
      onto.filled.mat(*px) = 255;
    }
  }
}

}  // namespace stillmap
