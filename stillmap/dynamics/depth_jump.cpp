// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dynamics/depth_jump.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

int cells_in(int pixels) {
  return (pixels + 1) / 2;
}

struct Nearest {
  float min_m = 1e9F;
  float max_m = 0.0F;
  int known = 0;  // cells
};

/// The least and greatest known depth of the three cells around each of a row.
void widen_row(const cv::Mat1f& cells, int row, std::vector<Nearest>& result) {
  const float* z = cells[row];
  for (int c = 0; c < cells.cols; ++c) {
    Nearest n;
    for (int k = std::max(0, c - 1); k <= std::min(cells.cols - 1, c + 1); ++k) {
      if (!(z[k] > 0)) continue;
      n.min_m = std::min(n.min_m, z[k]);
      n.max_m = std::max(n.max_m, z[k]);
      ++n.known;
    }
    result[static_cast<std::size_t>(c)] = n;
  }
}

std::uint8_t jump_of(float z, const Nearest& expected, const DepthJumpConfig& config) {
  if (!(z > 0)) return kNoJump;
  const auto limit =
      static_cast<float>(config.jump_m) + static_cast<float>(config.jump_per_m) * z * z;
  if (z < expected.min_m - limit) return kCameNearer;
  // Beside an edge, a strip comes into view because the camera moves: nothing is known of it.
  const bool seen_before = expected.known >= 7;
  return config.revealed && seen_before && z > expected.max_m + limit ? kWentFarther : kNoJump;
}

}  // namespace

cv::Mat1b depth_jumps(const DepthImage& current, const DepthImage& previous, double jump_m) {
  STILLMAP_CHECK(current.mat.size() == previous.mat.size());
  cv::Mat1b jumps(current.mat.size());
  const auto limit = static_cast<float>(jump_m);
  for (int row = 0; row < jumps.rows; ++row) {
    const float* now = current.mat[row];
    const float* before = previous.mat[row];
    std::uint8_t* jump = jumps[row];
    for (int x = 0; x < jumps.cols; ++x) {
      const bool known = now[x] > 0 && before[x] > 0;
      const bool nearer = before[x] - now[x] > limit;
      const bool farther = now[x] - before[x] > limit;
      jump[x] = static_cast<std::uint8_t>(
          known ? (nearer ? kCameNearer : 0) + (farther ? kWentFarther : 0) : 0);
    }
  }
  return jumps;
}

DepthWarper::DepthWarper(const CameraModel& camera)
    : camera_(camera), rays_(cells_in(camera.height_px), cells_in(camera.width_px)) {
  const cv::Mat2f all = pixel_rays(camera);
  for (int row = 0; row < rays_.rows; ++row) {
    for (int c = 0; c < rays_.cols; ++c) rays_(row, c) = all(2 * row, 2 * c);
  }
}

WarpedDepth DepthWarper::warp(const DepthImage& previous,
                              const Eigen::Isometry3d& T_current_previous) const {
  STILLMAP_CHECK(previous.mat.rows == camera_.height_px && previous.mat.cols == camera_.width_px);
  const Eigen::Matrix3f R = T_current_previous.linear().cast<float>();
  const Eigen::Vector3f t = T_current_previous.translation().cast<float>();
  const auto fx = static_cast<float>(camera_.fx / 2), fy = static_cast<float>(camera_.fy / 2);
  // A half more: to truncate is then to round to the nearest cell.
  const auto cx = static_cast<float>(camera_.cx / 2 + 0.5),
             cy = static_cast<float>(camera_.cy / 2 + 0.5);
  const auto k1 = static_cast<float>(camera_.k1), k2 = static_cast<float>(camera_.k2);
  const auto k3 = static_cast<float>(camera_.k3), p1 = static_cast<float>(camera_.p1);
  const auto p2 = static_cast<float>(camera_.p2);
  WarpedDepth warped{cv::Mat1f(rays_.size(), 0.0F)};
  const auto columns = static_cast<float>(rays_.cols), rows = static_cast<float>(rays_.rows);
  for (int row = 0; row < rays_.rows; ++row) {
    const float* depth = previous.mat[2 * row];
    const cv::Vec2f* rays = rays_[row];
    for (int c = 0; c < rays_.cols; ++c) {
      const float z = depth[2 * c];
      if (!(z > 0)) continue;
      const Eigen::Vector3f p = R * Eigen::Vector3f(rays[c][0] * z, rays[c][1] * z, z) + t;
      if (!(p.z() > 0.01F)) continue;
      const float x = p.x() / p.z(), y = p.y() / p.z();
      const float r2 = x * x + y * y;
      const float radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
      const float u = fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx;
      const float v = fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + cy;
      if (!(u >= 0 && v >= 0 && u < columns && v < rows)) continue;
      float& cell = warped.mat(static_cast<int>(v), static_cast<int>(u));
      if (cell == 0 || p.z() < cell) cell = p.z();
    }
  }
  return warped;
}

cv::Mat1b depth_jumps(const DepthImage& current,
                      const WarpedDepth& expected,
                      const DepthJumpConfig& config) {
  const cv::Mat1f& cells = expected.mat;
  STILLMAP_CHECK(cells.rows == cells_in(current.mat.rows) &&
                 cells.cols == cells_in(current.mat.cols));
  cv::Mat1b jumps(current.mat.size(), std::uint8_t{kNoJump});
  const auto width = static_cast<std::size_t>(cells.cols);
  std::vector<Nearest> above(width), here(width), below(width);
  widen_row(cells, 0, below);
  for (int row = 0; row < cells.rows; ++row) {
    above.swap(here);
    here.swap(below);
    std::ranges::fill(below, Nearest{});
    if (row + 1 < cells.rows) widen_row(cells, row + 1, below);
    for (int c = 0; c < cells.cols; ++c) {
      if (!(cells(row, c) > 0)) continue;
      const auto k = static_cast<std::size_t>(c);
      const Nearest around{std::min({above[k].min_m, here[k].min_m, below[k].min_m}),
                           std::max({above[k].max_m, here[k].max_m, below[k].max_m}),
                           above[k].known + here[k].known + below[k].known};
      for (int y = 2 * row; y < std::min(2 * row + 2, jumps.rows); ++y) {
        for (int x = 2 * c; x < std::min(2 * c + 2, jumps.cols); ++x) {
          jumps(y, x) = jump_of(current.mat(y, x), around, config);
        }
      }
    }
  }
  return jumps;
}

}  // namespace stillmap
