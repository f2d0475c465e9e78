// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/local_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/label_vote.hpp"
#include "stillmap/dense/mean_color.hpp"

namespace stillmap {
namespace {

constexpr float kSteepest = 1e3F;

/// Sums over the pixels of one point.
struct PointSum {
  std::uint32_t count = 0;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  std::array<std::uint32_t, 3> color{};
  LabelVote labels;

  void add(const cv::Vec2f& ray, float z, const cv::Vec3b& rgb) {
    position += Eigen::Vector3f(ray[0] * z, ray[1] * z, z);
    for (int c = 0; c < 3; ++c) color[static_cast<std::size_t>(c)] += rgb[c];
    ++count;
  }

  void append_mean_to(PointCloud& cloud) const {
    cloud.positions.emplace_back(position / static_cast<float>(count));
    cloud.colors.push_back(mean_color(color, count));
  }
};

struct Images {
  const cv::Mat1f& depth;
  const cv::Mat3b& color;
  const cv::Mat2f& rays;
  const cv::Mat1b& labels;
};

/// Makes the points cell by cell.
class CellPoints {
 public:
  CellPoints(const Images& images, const LocalCloudConfig& config)
      : images_(images),
        growth_(static_cast<float>(config.join_per_m)),
        offset_(static_cast<float>(config.join_offset_m)) {}

  void append_cell(const cv::Rect& cell, PointCloud& cloud) {
    points_.clear();
    for (int row = cell.y; row < cell.y + cell.height; ++row) add_row(row, cell);
    for (const PointSum& point : points_) {
      point.append_mean_to(cloud);
      if (!images_.labels.empty()) cloud.labels.push_back(point.labels.winner());
    }
  }

 private:
  void add_row(int row, const cv::Rect& cell) {
    const float* z = images_.depth[row];
    const cv::Vec2f* ray = images_.rays[row];
    const cv::Vec3b* rgb = images_.color[row];
    for (int x = cell.x; x < cell.x + cell.width; ++x) {
      // A ray too steep for a lens comes from a distortion that could not be inverted.
      const bool known = std::abs(ray[x][0]) < kSteepest && std::abs(ray[x][1]) < kSteepest;
      if (!(z[x] > 0 && known)) continue;
      PointSum& point = point_at(z[x]);
      point.add(ray[x], z[x], rgb[x]);
      if (!images_.labels.empty() && point.count <= LabelVote::kMostVotes) {
        point.labels.add(images_.labels(row, x), 1);
      }
    }
  }

  /// The point that a pixel of this depth joins. Most cells have one or two points.
  PointSum& point_at(float z) {
    const float reach = growth_ * (z + offset_) * (z + offset_);
    for (std::size_t i = points_.size(); i-- > 0;) {
      const auto count = static_cast<float>(points_[i].count);
      if (std::abs(z * count - points_[i].position.z()) <= reach * count) return points_[i];
    }
    return points_.emplace_back();
  }

  const Images& images_;
  float growth_, offset_;
  std::vector<PointSum> points_;
};

}  // namespace

int cell_side(int width_px, const LocalCloudConfig& config) {
  return std::max(1, (width_px + config.cells_across / 2) / config.cells_across);
}

PointCloud local_cloud(const cv::Mat1f& depth,
                       const ColorImage& color,
                       const cv::Mat2f& rays,
                       const LocalCloudConfig& config,
                       const LabelImage& labels) {
  STILLMAP_CHECK(depth.size() == rays.size() && color.mat.size() == rays.size());
  STILLMAP_CHECK(labels.empty() || labels.mat.size() == rays.size());
  STILLMAP_CHECK(config.cells_across > 0);
  const int side = cell_side(depth.cols, config);
  const Images images{depth, color.mat, rays, labels.mat};
  CellPoints points(images, config);
  PointCloud cloud;
  for (int row = 0; row < depth.rows; row += side) {
    for (int x = 0; x < depth.cols; x += side) {
      points.append_cell({x, row, std::min(side, depth.cols - x), std::min(side, depth.rows - row)},
                         cloud);
    }
  }
  cloud.positions.shrink_to_fit();
  cloud.colors.shrink_to_fit();
  cloud.labels.shrink_to_fit();
  return cloud;
}

}  // namespace stillmap
