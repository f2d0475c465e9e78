// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/frame_sample.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "stillmap/io/image_io.hpp"
#include "tooling/report/frame_picture.hpp"

namespace stillmap {
namespace {

constexpr std::uint16_t kLongestRun = 65535;

/// Whether the depth a few pixels to the right and below is nearly the same.
bool is_inside_surface(const cv::Mat1f& depth, int row, int column) {
  constexpr int kReach_px = 2;
  constexpr float kLargestStep = 0.03F;
  if (row + kReach_px >= depth.rows || column + kReach_px >= depth.cols) return false;
  const float here = depth(row, column);
  return std::abs(depth(row + kReach_px, column) - here) < kLargestStep * here &&
         std::abs(depth(row, column + kReach_px) - here) < kLargestStep * here;
}

/// 21 bits a coordinate: 20 km in both directions.
std::uint64_t voxel_key(const Eigen::Vector3f& p) {
  constexpr std::int64_t kHalf = 1 << 20;
  std::uint64_t key = 0;
  for (const float coordinate : p) {
    const auto voxel = static_cast<std::int64_t>(
        std::floor(static_cast<double>(coordinate) / GrowingMap::kVoxel_m));
    key = (key << 21U) |
          static_cast<std::uint64_t>(std::clamp(voxel + kHalf, std::int64_t{0}, 2 * kHalf - 1));
  }
  return key;
}

bool fits(const cv::Mat1b& mask, const cv::Mat3b& image) {
  return !mask.empty() && mask.size() == image.size();
}

}  // namespace

PixelGrid::PixelGrid(const CameraModel& camera, int width)
    : step_(std::max(1, camera.width_px / width)) {
  for (int row = step_ / 2; row < camera.height_px; row += step_) {
    for (int column = step_ / 2; column < camera.width_px; column += step_) {
      const Eigen::Vector2d ideal_px = camera.undistort({column, row});
      if (!camera.has_ray(ideal_px)) continue;
      const Eigen::Vector3f ray = camera.unproject(ideal_px, 1.0).cast<float>();
      pixels_.push_back({row, column, ray.x(), ray.y()});
    }
  }
}

GrowingMap::GrowingMap(const CameraModel& camera) : grid_(camera, 160) {}

PointCloud GrowingMap::add(const ViewedSample& sample) {
  constexpr float kFarthest_m = 6;
  const auto& [frame, result] = sample;
  PointCloud added;
  if (!has_pose(result)) return added;
  const Eigen::Isometry3f T_world_camera = result.T_world_camera.cast<float>();
  const bool masked = fits(result.excluded.mat, frame.color.mat);
  for (const PixelGrid::Pixel& pixel : grid_.pixels()) {
    if (seen_.size() >= kMostPoints) break;
    const float depth_m = frame.depth.mat(pixel.row, pixel.column);
    if (!(depth_m > 0 && depth_m < kFarthest_m)) continue;
    if (masked && result.excluded.covers(pixel.row, pixel.column)) continue;
    if (!is_inside_surface(frame.depth.mat, pixel.row, pixel.column)) continue;
    const Eigen::Vector3f p_world =
        T_world_camera * Eigen::Vector3f(pixel.x * depth_m, pixel.y * depth_m, depth_m);
    if (!seen_.insert(voxel_key(p_world)).second) continue;
    const cv::Vec3b& color = frame.color.mat(pixel.row, pixel.column);
    added.positions.push_back(p_world);
    added.colors.push_back({color[0], color[1], color[2]});
  }
  return added;
}

GhostPoints ghost_points(const ViewedSample& sample, const PixelGrid& grid) {
  const auto& [frame, result] = sample;
  GhostPoints ghosts;
  if (!fits(result.object_mask.mat, frame.color.mat)) return ghosts;
  for (const PixelGrid::Pixel& pixel : grid.pixels()) {
    const std::size_t id = result.object_mask.mat(pixel.row, pixel.column);
    if (id == 0 || id > result.objects.size() || !result.objects[id - 1].dynamic) continue;
    const float depth_m = frame.depth.mat(pixel.row, pixel.column);
    if (!(depth_m > 0)) continue;
    const cv::Vec3b& color = frame.color.mat(pixel.row, pixel.column);
    ghosts.add({pixel.x * depth_m, pixel.y * depth_m, depth_m},
               {color[0], color[1], color[2]},
               static_cast<std::uint8_t>(id - 1));
  }
  return ghosts;
}

std::vector<std::uint16_t> feature_marks(const ViewedSample& sample) {
  const auto& [frame, result] = sample;
  std::vector<std::uint16_t> marks;
  marks.reserve(3 * result.features.size());
  for (const FeatureMark& feature : result.features) {
    const Eigen::Vector2f& at = feature.raw_px;
    if (!at.allFinite() || at.x() < 0 || at.y() < 0 ||
        at.x() >= static_cast<float>(frame.color.mat.cols) ||
        at.y() >= static_cast<float>(frame.color.mat.rows)) {
      continue;
    }
    const std::ptrdiff_t style = &style_of(feature) - verdict_styles().data();
    marks.push_back(static_cast<std::uint16_t>(at.x() * 4));
    marks.push_back(static_cast<std::uint16_t>(at.y() * 4));
    marks.push_back(static_cast<std::uint16_t>(style));
  }
  return marks;
}

MaskRuns mask_runs(const ViewedSample& sample, int width_px) {
  const auto& [frame, result] = sample;
  const cv::Mat3b& image = frame.color.mat;
  struct FittingMask {
    const cv::Mat1b* mask;
    unsigned bit;
  };
  std::vector<FittingMask> masks;
  for (const FittingMask& candidate : {FittingMask{&result.network_mask.mat, 1},
                                       FittingMask{&result.extended_mask.mat, 2},
                                       FittingMask{&result.depth_jumps.mat, 4}}) {
    if (fits(*candidate.mask, image)) masks.push_back(candidate);
  }
  MaskRuns reduced;
  if (masks.empty()) return reduced;
  const int step = std::max(1, (image.cols + width_px - 1) / width_px);
  reduced.width_px = (image.cols + step - 1) / step;
  reduced.height_px = (image.rows + step - 1) / step;
  for (int row = 0; row < image.rows; row += step) {
    for (int column = 0; column < image.cols; column += step) {
      unsigned bits = 0;
      for (const FittingMask& fitting : masks) {
        if ((*fitting.mask)(row, column) != 0) bits |= fitting.bit;
      }
      std::vector<std::uint16_t>& runs = reduced.runs;
      if (runs.empty() || runs[runs.size() - 2] != bits || runs.back() == kLongestRun) {
        runs.insert(runs.end(), {static_cast<std::uint16_t>(bits), std::uint16_t{0}});
      }
      ++runs.back();
    }
  }
  return reduced;
}

std::vector<std::uint8_t> picture_jpeg(const ColorImage& image, int width_px) {
  constexpr int kQuality = 75;
  if (image.mat.empty()) return {};
  if (image.mat.cols <= width_px) return encode_jpeg(image, kQuality);
  const double scale = static_cast<double>(width_px) / image.mat.cols;
  cv::Mat3b small;
  const cv::Size size(width_px, std::max(1, cvRound(image.mat.rows * scale)));
  cv::resize(image.mat, small, size, 0, 0, cv::INTER_AREA);
  return encode_jpeg(ColorImage(small), kQuality);
}

}  // namespace stillmap
