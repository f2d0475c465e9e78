// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/orb_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/slam/features/brief.hpp"
#include "stillmap/slam/features/fast_corners.hpp"
#include "stillmap/slam/features/feature_slope.hpp"
#include "stillmap/slam/features/patch_blur.hpp"
#include "stillmap/slam/features/spread.hpp"

namespace stillmap {
namespace {

constexpr int kBorderPx = kPatchRadiusPx + 2;  // keeps a rotated, rounded patch inside
constexpr int kCellPx = 32;

int cell_count(int length_px) {
  return std::max(1, length_px / kCellPx);
}

// The corners of the image of a level. The mask has the size of the finest level.
void remove_excluded(std::vector<cv::KeyPoint>& corners, const cv::Mat1b& mask, cv::Size level) {
  const float scale_x = static_cast<float>(mask.cols) / static_cast<float>(level.width);
  const float scale_y = static_cast<float>(mask.rows) / static_cast<float>(level.height);
  std::erase_if(corners, [&](const cv::KeyPoint& corner) {
    const int x = static_cast<int>((corner.pt.x + 0.5F) * scale_x);
    const int y = static_cast<int>((corner.pt.y + 0.5F) * scale_y);
    return mask(std::min(y, mask.rows - 1), std::min(x, mask.cols - 1)) != 0;
  });
}

}  // namespace

std::vector<float> pyramid_scales(const OrbConfig& config) {
  std::vector<float> scales;
  double scale = 1.0;
  for (int i = 0; i < config.levels; ++i, scale *= config.scale_factor) {
    scales.push_back(static_cast<float>(scale));
  }
  return scales;
}

OrbExtractor::OrbExtractor(const OrbConfig& config, const CameraModel& camera)
    : config_(config), camera_(camera), scales_(pyramid_scales(config)) {
  // Features are distributed in proportion to the widths of the levels, as in ORB.
  double total = 0;
  for (const float scale : scales_) total += 1.0 / scale;
  for (const float scale : scales_) {
    const cv::Size size(cvRound(static_cast<float>(camera.width_px) / scale),
                        cvRound(static_cast<float>(camera.height_px) / scale));
    if (size.width <= 2 * kBorderPx + kCellPx / 2 || size.height <= 2 * kBorderPx + kCellPx / 2) {
      break;  // too small for a feature
    }
    levels_.push_back({size, static_cast<int>(std::lround(config.features / scale / total))});
  }
}

ImageCorners OrbExtractor::corners(const GrayImage& gray) const {
  STILLMAP_CHECK(gray.mat.cols == camera_.width_px && gray.mat.rows == camera_.height_px);
  ImageCorners found;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    ImageCorners::Level level;
    if (i == 0) {
      level.image = gray.mat;  // shared and never written
    } else {
      cv::resize(found.levels[i - 1].image, level.image, levels_[i].size, 0, 0, cv::INTER_LINEAR);
    }
    level.blurred = blurred_for_descriptors(level.image);
    level.corners = detect(level.image);
    found.levels.push_back(std::move(level));
  }
  return found;
}

std::vector<cv::KeyPoint> OrbExtractor::detect(const cv::Mat1b& image) const {
  const cv::Mat1b scores = corner_scores(image);
  const cv::Rect inner(
      kBorderPx, kBorderPx, image.cols - 2 * kBorderPx, image.rows - 2 * kBorderPx);
  std::vector<cv::KeyPoint> corners = local_maxima(scores, inner, config_.corner_threshold);

  // Cells without a corner are searched for weaker corners.
  constexpr int kMargin = kBorderPx - kCornerCircleRadiusPx;
  const cv::Rect area(kMargin, kMargin, image.cols - 2 * kMargin, image.rows - 2 * kMargin);
  const int columns = cell_count(area.width), rows = cell_count(area.height);
  std::vector<char> occupied(static_cast<std::size_t>(columns * rows), 0);
  for (const cv::KeyPoint& corner : corners) {
    const int column = (static_cast<int>(corner.pt.x) - area.x) * columns / area.width;
    const int row = (static_cast<int>(corner.pt.y) - area.y) * rows / area.height;
    occupied[static_cast<std::size_t>(row * columns + column)] = 1;
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (occupied[static_cast<std::size_t>(row * columns + column)] != 0) continue;
      const cv::Point from(column * area.width / columns, row * area.height / rows);
      const cv::Point to((column + 1) * area.width / columns, (row + 1) * area.height / rows);
      const cv::Rect cell = cv::Rect(area.tl() + from, area.tl() + to) & inner;
      const std::vector<cv::KeyPoint> weak =
          local_maxima(scores, cell, config_.weak_corner_threshold);
      corners.insert(corners.end(), weak.begin(), weak.end());
    }
  }
  return corners;
}

void OrbExtractor::append(std::size_t number,
                          const ImageCorners::Level& level,
                          const std::vector<cv::KeyPoint>& corners,
                          Features& features) const {
  // Sizes are rounded, so that the scale of a level differs slightly from the nominal one. Pixel
  // centres are at whole numbers; the edges, half a pixel off, are what scales.
  const cv::Mat1b& image = level.image;
  const float scale_x = static_cast<float>(camera_.width_px) / static_cast<float>(image.cols);
  const float scale_y = static_cast<float>(camera_.height_px) / static_cast<float>(image.rows);
  for (const cv::KeyPoint& corner : corners) {
    const cv::Point at(static_cast<int>(corner.pt.x), static_cast<int>(corner.pt.y));
    const Eigen::Vector2f raw((corner.pt.x + 0.5F) * scale_x - 0.5F,
                              (corner.pt.y + 0.5F) * scale_y - 0.5F);
    const Eigen::Vector2d ideal = camera_.undistort(raw.cast<double>());
    if (camera_.unproject(ideal, 1.0).head<2>().norm() > kSteepestFeature) continue;
    const float angle_deg = patch_orientation_deg(image, at);
    features.raw_px.push_back(raw);
    features.ideal_px.push_back(ideal.cast<float>());
    features.level.push_back(static_cast<std::uint8_t>(number));
    features.angle_deg.push_back(angle_deg);
    features.descriptors.push_back(rotated_brief(level.blurred, at, angle_deg));
  }
}

void OrbExtractor::place_in_space(const DepthImage& depth, Features& features) const {
  features.sensor_depth_m.reserve(features.raw_px.size());
  for (const Eigen::Vector2f& raw : features.raw_px) {
    const int u = std::min(cvRound(raw.x()), depth.mat.cols - 1);
    const int v = std::min(cvRound(raw.y()), depth.mat.rows - 1);
    features.sensor_depth_m.push_back(depth.mat(v, u));
  }
  features.px = features.ideal_px;
  features.depth_m = features.sensor_depth_m;
  features.grid = FeatureGrid(features.px, camera_.width_px, camera_.height_px);
}

Features OrbExtractor::extract(const ImageCorners& corners,
                               const DepthImage& depth,
                               const Mask& excluded) const {
  STILLMAP_CHECK(depth.mat.cols == camera_.width_px && depth.mat.rows == camera_.height_px);
  STILLMAP_CHECK(excluded.empty() || excluded.mat.size() == depth.mat.size());
  STILLMAP_CHECK(corners.levels.size() == levels_.size());
  Features features;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const ImageCorners::Level& level = corners.levels[i];
    std::vector<cv::KeyPoint> usable = level.corners;
    if (!excluded.empty()) remove_excluded(usable, excluded.mat, level.image.size());
    append(i, level, spread_evenly(std::move(usable), levels_[i].feature_count), features);
  }
  place_in_space(depth, features);
  return features;
}

}  // namespace stillmap
