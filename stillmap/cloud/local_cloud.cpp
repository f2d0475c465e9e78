// SPDX-License-Identifier: Apache-2.0
#include "stillmap/cloud/local_cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "stillmap/cloud/key_order.hpp"
#include "stillmap/cloud/label_vote.hpp"
#include "stillmap/core/error.hpp"

// Not by VoxelGrid: as all points are known at once, sorting them by voxel takes half the time.

namespace stillmap {
namespace {

Eigen::Vector3f point_of(const cv::Vec2f& ray, float z) {
  return {ray[0] * z, ray[1] * z, z};
}

/// Numbers the voxels around the camera, in as few bits as reach far enough: fewer bits, less time.
class VoxelKeys {
 public:
  VoxelKeys(const cv::Mat2f& rays, const LocalCloudConfig& config)
      : voxels_per_m_(1.0 / config.voxel_size_m) {
    float steepest = 1.0F;  // the optical axis' own slope
    for (int row = 0; row < rays.rows; ++row) {
      for (int x = 0; x < rays.cols; ++x) {
        steepest = std::max({steepest, std::abs(rays[row][x][0]), std::abs(rays[row][x][1])});
      }
    }
    const double reach = static_cast<double>(steepest) * config.max_depth_m * voxels_per_m_;
    const auto voxels = static_cast<std::uint64_t>(std::min(1e6, reach + 2.0));
    bits_ = static_cast<unsigned>(std::bit_width(voxels)) + 1;
    offset_ = std::int64_t{1} << (bits_ - 1);
  }

  /// Ordered by x, then y, then z; kOutside for a point that is not finite or out of reach.
  [[nodiscard]] std::uint64_t operator()(const Eigen::Vector3f& p) const {
    const Eigen::Vector3d scaled = p.cast<double>() * voxels_per_m_;
    const auto limit = static_cast<double>(offset_ - 1);
    if (!(scaled.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < limit)) return kOutside;
    return (axis(scaled.x()) << bits_ | axis(scaled.y())) << bits_ | axis(scaled.z());
  }

  static constexpr std::uint64_t kOutside = std::numeric_limits<std::uint64_t>::max();

 private:
  /// Shifted to be positive, where to truncate is to round down.
  [[nodiscard]] std::uint64_t axis(double scaled) const {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(scaled + static_cast<double>(offset_)));
  }

  double voxels_per_m_;
  unsigned bits_ = 0;
  std::int64_t offset_ = 0;
};

/// The pixels that have a usable point, by voxel.
std::vector<IndexedKey> pixels_by_voxel(const cv::Mat1f& depth,
                                        const cv::Mat2f& rays,
                                        const LocalCloudConfig& config,
                                        const cv::Mat1b& dynamic) {
  const VoxelKeys key_of(rays, config);
  const auto max_depth = static_cast<float>(config.max_depth_m);
  std::vector<IndexedKey> pixels;
  pixels.reserve(depth.total());
  for (int row = 0; row < depth.rows; ++row) {
    const float* z = depth[row];
    const cv::Vec2f* ray = rays[row];
    const std::uint8_t* moves = dynamic.empty() ? nullptr : dynamic[row];
    for (int x = 0; x < depth.cols; ++x) {
      if (moves != nullptr && moves[x] != 0) continue;
      if (!(z[x] > 0 && z[x] <= max_depth)) continue;  // so written, NaN is left out too
      const std::uint64_t key = key_of(point_of(ray[x], z[x]));
      if (key == VoxelKeys::kOutside) continue;
      pixels.push_back({key, static_cast<std::uint32_t>(row * depth.cols + x)});
    }
  }
  return sorted_by_key(std::move(pixels));
}

constexpr std::uint32_t kMostVotes = 65535;  // what a LabelVote can count

/// Sums over the pixels of one voxel.
struct PointSum {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::array<std::uint32_t, 3> color{};
  std::uint32_t count = 0;
  LabelVote labels;

  void vote(std::uint8_t label) {
    if (count <= kMostVotes) labels.add(label, 1);
  }

  void add(const Eigen::Vector3f& p, const cv::Vec3b& rgb) {
    position += p.cast<double>();
    for (int c = 0; c < 3; ++c) color[static_cast<std::size_t>(c)] += rgb[c];
    ++count;
  }

  void append_mean_to(PointCloud& cloud) const {
    const auto mean = [this](std::uint32_t sum) {
      return static_cast<std::uint8_t>((sum + count / 2) / count);
    };
    cloud.positions.emplace_back((position / count).cast<float>());
    cloud.colors.push_back({mean(color[0]), mean(color[1]), mean(color[2])});
  }
};

std::size_t count_voxels(const std::vector<IndexedKey>& pixels) {
  std::size_t count = pixels.empty() ? 0 : 1;
  for (std::size_t i = 1; i < pixels.size(); ++i) count += pixels[i].key != pixels[i - 1].key;
  return count;
}

}  // namespace

PointCloud local_cloud(const RgbdFrame& frame,
                       const cv::Mat2f& rays,
                       const LocalCloudConfig& config,
                       const cv::Mat1b& dynamic,
                       const cv::Mat1b& labels) {
  const cv::Mat1f& depth = frame.depth.mat;
  const cv::Mat3b& color = frame.color.mat;
  STILLMAP_CHECK(depth.size() == rays.size() && color.size() == rays.size());
  STILLMAP_CHECK(dynamic.empty() || dynamic.size() == rays.size());
  STILLMAP_CHECK(labels.empty() || labels.size() == rays.size());
  STILLMAP_CHECK(config.voxel_size_m > 0);
  const std::vector<IndexedKey> pixels = pixels_by_voxel(depth, rays, config, dynamic);
  const std::size_t voxels = count_voxels(pixels);
  PointCloud cloud;
  cloud.positions.reserve(voxels);
  cloud.colors.reserve(voxels);
  if (!labels.empty()) cloud.labels.reserve(voxels);
  for (std::size_t i = 0; i < pixels.size();) {
    const std::uint64_t key = pixels[i].key;
    PointSum sum;
    for (; i < pixels.size() && pixels[i].key == key; ++i) {
      const int row = static_cast<int>(pixels[i].index) / depth.cols;
      const int x = static_cast<int>(pixels[i].index) % depth.cols;
      sum.add(point_of(rays(row, x), depth(row, x)), color(row, x));
      if (!labels.empty()) sum.vote(labels(row, x));
    }
    sum.append_mean_to(cloud);
    if (!labels.empty()) cloud.labels.push_back(sum.labels.winner());
  }
  return cloud;
}

}  // namespace stillmap
