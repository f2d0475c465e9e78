// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/frame_picture.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

constexpr std::array<VerdictStyle, 7> kStyles = {
    {{FeatureVerdict::kStable, false, "found but not tracked", 2, {165, 165, 165}},
     {FeatureVerdict::kMissingDepth, false, "with depth missing", 2, {70, 160, 255}},
     {FeatureVerdict::kUnstableDepth, false, "at a jump of depth", 2, {255, 150, 0}},
     {FeatureVerdict::kDynamic, false, "dynamic", 3, {255, 60, 200}},
     {FeatureVerdict::kStaticInBox,
      false,
      "static in the box of something dynamic",
      3,
      {0, 230, 255}},
     {FeatureVerdict::kDoubted, true, "on something dynamic, used in need", 3, {220, 255, 60}},
     {FeatureVerdict::kStable, true, "tracked", 3, {40, 255, 110}}}};

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

/// The mask in the picture's size, 255 where it is not 0; empty if it does not fit the image.
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

const VerdictStyle& style_of(const FeatureMark& feature) {
  return *std::ranges::find_if(kStyles, [&](const VerdictStyle& style) {
    const bool stable = feature.verdict == FeatureVerdict::kStable;
    return style.verdict == feature.verdict && (!stable || style.tracked == feature.tracked);
  });
}

ColorImage draw_frame(const ReportSample& sample, int max_width_px) {
  const auto& [frame, result] = sample;
  const cv::Mat3b& image = frame.color.mat;
  if (image.empty()) return {};
  ColorImage drawn = resized(frame.color, max_width_px);
  cv::Mat3b& picture = drawn.mat;
  const auto fit = [size = image.size(), &picture](const cv::Mat1b& mask) {
    return fitted(mask, size, picture.size());
  };
  tint(picture, fit(result.extended_mask.mat), MaskStyle::kExtended, 0.4);
  tint(picture, fit(result.depth_jumps.mat), MaskStyle::kJumps, 0.45);
  outline(picture, fit(result.network_mask.mat), MaskStyle::kNetwork);
  const float scale = static_cast<float>(picture.cols) / static_cast<float>(image.cols);
  for (const VerdictStyle& style : kStyles) {
    for (const FeatureMark& feature : result.features) {
      if (&style_of(feature) == &style) draw_ring(picture, feature.raw_px * scale, style);
    }
  }
  return drawn;
}

}  // namespace stillmap
