// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/frame_picture.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

constexpr std::array<VerdictStyle, 6> kStyles = {
    {{SampleVerdict::kUntracked, "found but not tracked", 2, {165, 165, 165}},
     {SampleVerdict::kMissingDepth, "with depth missing", 2, {70, 160, 255}},
     {SampleVerdict::kDepthJump, "at a jump of depth", 2, {255, 150, 0}},
     {SampleVerdict::kDynamic, "dynamic", 3, {255, 60, 200}},
     {SampleVerdict::kStaticInBox, "static in the box of something dynamic", 3, {0, 230, 255}},
     {SampleVerdict::kTracked, "tracked", 3, {40, 255, 110}}}};

cv::Scalar scalar(Rgb color) {
  return {
      static_cast<double>(color[0]), static_cast<double>(color[1]), static_cast<double>(color[2])};
}

ColorImage resized(const ColorImage& image, int max_width_px) {
  if (image.mat.cols <= max_width_px) return ColorImage(image.mat.clone());
  const double scale = static_cast<double>(max_width_px) / image.mat.cols;
  cv::Mat3b small;
  const cv::Size size(max_width_px, std::max(1, cvRound(image.mat.rows * scale)));
  cv::resize(image.mat, small, size, 0, 0, cv::INTER_AREA);
  return ColorImage(small);
}

/// The mask in the picture's size, 255 where it is not 0; empty where it does not fit the image.
cv::Mat1b fitted(const cv::Mat1b& mask, cv::Size image, cv::Size picture) {
  cv::Mat1b out;
  if (mask.empty() || mask.size() != image) return out;
  cv::resize(mask != 0, out, picture, 0, 0, cv::INTER_NEAREST);
  return out;
}

void tint(cv::Mat3b& picture, const cv::Mat1b& mask, Rgb color, double share) {
  if (mask.empty()) return;
  cv::Mat3b tinted;
  const cv::Mat3b plain(picture.size(), cv::Vec3b(color[0], color[1], color[2]));
  cv::addWeighted(picture, 1 - share, plain, share, 0, tinted);
  tinted.copyTo(picture, mask);
}

void outline(cv::Mat3b& picture, const cv::Mat1b& mask, Rgb color) {
  if (mask.empty()) return;
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture, contours, -1, scalar(color), 1, cv::LINE_AA);
}

void draw_ring(cv::Mat3b& picture, const Eigen::Vector2f& center, const VerdictStyle& style) {
  constexpr int kShift = 4;  // centres in sixteenths of a pixel
  const cv::Rect2f inside(0, 0, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
  if (!center.allFinite() || !inside.contains({center.x(), center.y()})) return;
  const cv::Point at(cvRound(center.x() * 16), cvRound(center.y() * 16));
  cv::circle(picture, at, style.radius_px * 16, scalar(style.color), 1, cv::LINE_AA, kShift);
}

}  // namespace

std::span<const VerdictStyle> verdict_styles() {
  return kStyles;
}

ColorImage draw_frame(const SampleFrame& frame, int max_width_px) {
  const cv::Mat3b& image = frame.image.mat;
  if (image.empty()) return {};
  ColorImage drawn = resized(frame.image, max_width_px);
  cv::Mat3b& picture = drawn.mat;
  const auto fit = [&](const cv::Mat1b& mask) {
    return fitted(mask, image.size(), picture.size());
  };
  tint(picture, fit(frame.extended_mask), MaskStyle::kExtended, 0.4);
  tint(picture, fit(frame.jumps), MaskStyle::kJumps, 0.45);
  outline(picture, fit(frame.raw_mask), MaskStyle::kRaw);
  const float scale = static_cast<float>(picture.cols) / static_cast<float>(image.cols);
  for (const VerdictStyle& style : kStyles) {
    for (const SampleFeature& feature : frame.features) {
      if (feature.verdict == style.verdict) draw_ring(picture, feature.raw_px * scale, style);
    }
  }
  return drawn;
}

}  // namespace stillmap
