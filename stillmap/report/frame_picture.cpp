// SPDX-License-Identifier: Apache-2.0
#include "stillmap/report/frame_picture.hpp"

#include <algorithm>
#include <span>

#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

struct RingStyle {
  int radius_px;
  cv::Scalar color;
};

void draw_rings(cv::Mat3b& picture,
                std::span<const Eigen::Vector2f> centers,
                const RingStyle& style) {
  constexpr int kShift = 4;  // centres in sixteenths of a pixel
  const cv::Rect2f inside(0, 0, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
  for (const Eigen::Vector2f& center : centers) {
    if (!center.allFinite() || !inside.contains({center.x(), center.y()})) continue;
    const cv::Point at(cvRound(center.x() * 16), cvRound(center.y() * 16));
    cv::circle(picture, at, style.radius_px * 16, style.color, 1, cv::LINE_AA, kShift);
  }
}

std::vector<Eigen::Vector2f> scaled(const std::vector<Eigen::Vector2f>& points, float scale) {
  std::vector<Eigen::Vector2f> out(points.size());
  std::transform(points.begin(), points.end(), out.begin(), [scale](const Eigen::Vector2f& p) {
    return Eigen::Vector2f(p * scale);
  });
  return out;
}

}  // namespace

ColorImage draw_features(const SampleFrame& frame, int max_width_px) {
  if (frame.image.mat.empty()) return {};
  cv::Mat3b picture;
  float scale = 1;
  if (frame.image.mat.cols > max_width_px) {
    scale = static_cast<float>(max_width_px) / static_cast<float>(frame.image.mat.cols);
    const int height = std::max(1, cvRound(static_cast<float>(frame.image.mat.rows) * scale));
    cv::resize(frame.image.mat, picture, {max_width_px, height}, 0, 0, cv::INTER_AREA);
  } else {
    picture = frame.image.mat.clone();
  }
  draw_rings(picture, scaled(frame.untracked_px, scale), {2, {165, 165, 165}});
  draw_rings(picture, scaled(frame.tracked_px, scale), {3, {40, 255, 110}});
  return ColorImage(picture);
}

}  // namespace stillmap
