// SPDX-License-Identifier: Apache-2.0
#include "stillmap/features/orb_extractor.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/features/brief.hpp"
#include "stillmap/features/spread.hpp"

namespace stillmap {
namespace {

constexpr int kBorderPx = kPatchRadiusPx + 2;  // a rotated, rounded patch stays inside
constexpr int kFastRadiusPx = 3;
constexpr int kCellPx = 32;

int cell_count(int length_px) {
  return std::max(1, length_px / kCellPx);
}

// Corners of a level's image; the mask is as large as the finest one.
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
  // Features are shared out in proportion to the levels' widths, as ORB does.
  double total = 0;
  for (const float scale : scales_) total += 1.0 / scale;
  for (const float scale : scales_) {
    const cv::Size size(cvRound(static_cast<float>(camera.width_px) / scale),
                        cvRound(static_cast<float>(camera.height_px) / scale));
    if (size.width <= 2 * kBorderPx + kCellPx / 2 || size.height <= 2 * kBorderPx + kCellPx / 2) {
      break;  // too small to hold a feature
    }
    Level level;
    level.image.create(size);
    level.blurred.create(size);
    level.feature_count = static_cast<int>(std::lround(config.features / scale / total));
    levels_.push_back(level);
  }
}

void OrbExtractor::build_pyramid(const GrayImage& gray) {
  STILLMAP_CHECK(gray.mat.cols == camera_.width_px && gray.mat.rows == camera_.height_px);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    if (i == 0) {
      level.image = gray.mat;  // shared, only read
    } else {
      cv::resize(levels_[i - 1].image, level.image, level.image.size(), 0, 0, cv::INTER_LINEAR);
    }
    cv::GaussianBlur(level.image, level.blurred, cv::Size(7, 7), 2, 2, cv::BORDER_REFLECT_101);
  }
}

std::vector<cv::KeyPoint> OrbExtractor::detect(const cv::Mat1b& image,
                                               const cv::Mat1b& excluded) const {
  constexpr int kMargin = kBorderPx - kFastRadiusPx;
  const cv::Rect area(kMargin, kMargin, image.cols - 2 * kMargin, image.rows - 2 * kMargin);
  std::vector<cv::KeyPoint> corners;
  cv::FAST(image(area), corners, config_.corner_threshold, true);

  // Where a cell has none, weaker corners will do.
  const int columns = cell_count(area.width), rows = cell_count(area.height);
  std::vector<char> occupied(static_cast<std::size_t>(columns * rows), 0);
  for (const cv::KeyPoint& corner : corners) {
    const int column = std::min(static_cast<int>(corner.pt.x) * columns / area.width, columns - 1);
    const int row = std::min(static_cast<int>(corner.pt.y) * rows / area.height, rows - 1);
    occupied[static_cast<std::size_t>(row * columns + column)] = 1;
  }
  std::vector<cv::KeyPoint> weak;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (occupied[static_cast<std::size_t>(row * columns + column)] != 0) continue;
      const int x0 = column * area.width / columns, x1 = (column + 1) * area.width / columns;
      const int y0 = row * area.height / rows, y1 = (row + 1) * area.height / rows;
      const cv::Rect cell(std::max(x0 - kFastRadiusPx, 0), std::max(y0 - kFastRadiusPx, 0), 0, 0);
      const cv::Rect with_rim(cell.x,
                              cell.y,
                              std::min(x1 + kFastRadiusPx, area.width) - cell.x,
                              std::min(y1 + kFastRadiusPx, area.height) - cell.y);
      cv::FAST(image(area)(with_rim), weak, config_.weak_corner_threshold, true);
      for (cv::KeyPoint& corner : weak) {
        corner.pt += cv::Point2f(with_rim.tl());
        corners.push_back(corner);
      }
    }
  }
  for (cv::KeyPoint& corner : corners) corner.pt += cv::Point2f(area.tl());
  if (!excluded.empty()) remove_excluded(corners, excluded, image.size());
  return corners;
}

void OrbExtractor::append(std::size_t level,
                          const std::vector<cv::KeyPoint>& corners,
                          Features& features) const {
  // Sizes are rounded, so the scale of a level is not quite the nominal one. Pixels are squares
  // with their centres at whole numbers: it is their edges, half a pixel off, that scale.
  const cv::Mat1b& image = levels_[level].image;
  const float scale_x = static_cast<float>(camera_.width_px) / static_cast<float>(image.cols);
  const float scale_y = static_cast<float>(camera_.height_px) / static_cast<float>(image.rows);
  for (const cv::KeyPoint& corner : corners) {
    const cv::Point at(static_cast<int>(corner.pt.x), static_cast<int>(corner.pt.y));
    const float angle_deg = patch_orientation_deg(image, at);
    features.raw_px.emplace_back((corner.pt.x + 0.5F) * scale_x - 0.5F,
                                 (corner.pt.y + 0.5F) * scale_y - 0.5F);
    features.level.push_back(static_cast<std::uint8_t>(level));
    features.angle_deg.push_back(angle_deg);
    features.descriptors.push_back(rotated_brief(levels_[level].blurred, at, angle_deg));
  }
}

void OrbExtractor::place_in_space(const DepthImage& depth, Features& features) const {
  features.ideal_px.reserve(features.raw_px.size());
  features.sensor_depth_m.reserve(features.raw_px.size());
  for (const Eigen::Vector2f& raw : features.raw_px) {
    features.ideal_px.push_back(camera_.undistort(raw.cast<double>()).cast<float>());
    const int u = std::min(cvRound(raw.x()), depth.mat.cols - 1);
    const int v = std::min(cvRound(raw.y()), depth.mat.rows - 1);
    features.sensor_depth_m.push_back(depth.mat(v, u));
  }
  features.px = features.ideal_px;
  features.depth_m = features.sensor_depth_m;
  features.grid = FeatureGrid(features.px, camera_.width_px, camera_.height_px);
}

Features OrbExtractor::extract(const GrayImage& gray,
                               const DepthImage& depth,
                               const cv::Mat1b& excluded) {
  STILLMAP_CHECK(gray.mat.size() == depth.mat.size());
  STILLMAP_CHECK(excluded.empty() || excluded.size() == depth.mat.size());
  build_pyramid(gray);
  Features features;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    append(
        i, spread_evenly(detect(levels_[i].image, excluded), levels_[i].feature_count), features);
  }
  place_in_space(depth, features);
  return features;
}

}  // namespace stillmap
