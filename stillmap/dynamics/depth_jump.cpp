// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dynamics/depth_jump.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

int cells_in(int pixels) {
  return (pixels + 1) / 2;
}

constexpr float kVeryLarge = 1e6F;

struct Nearest {
  float min_m = 1e9F;
  float max_m = 0.0F;
  int known = 0;  // cells
};

/// The least and greatest known depth of the nine cells around one.
Nearest around(const cv::Mat1f& cells, int row, int column) {
  Nearest n;
  for (int r = std::max(0, row - 1); r <= std::min(cells.rows - 1, row + 1); ++r) {
    const float* z = cells[r];
    for (int c = std::max(0, column - 1); c <= std::min(cells.cols - 1, column + 1); ++c) {
      if (!(z[c] > 0)) continue;
      n.min_m = std::min(n.min_m, z[c]);
      n.max_m = std::max(n.max_m, z[c]);
      ++n.known;
    }
  }
  return n;
}

/// Finds the jumps of a row of pixels at a time.
class JumpFinder {
 public:
  JumpFinder(const cv::Mat1f& cells, const DepthJumpConfig& config, int columns)
      : cells_(cells),
        config_(config),
        base_(static_cast<float>(config.jump_m)),
        growth_(static_cast<float>(config.jump_per_m)),
        before_(static_cast<std::size_t>(columns)),
        candidate_(static_cast<std::size_t>(columns) + 8, 0) {}

  void mark(const float* depth, int row, std::uint8_t* jumps) {
    find_candidates(depth, row);
    const std::size_t columns = before_.size();
    for (std::size_t x = 0; x < columns; ++x) {
      std::uint64_t eight = 0;
      if (x % 8 == 0 && (std::memcpy(&eight, &candidate_[x], 8), eight == 0)) {
        x += 7;
        continue;
      }
      if (candidate_[x] == 0 || !(before_[x] > 0) || !(depth[x] > 0)) continue;
      jumps[x] = jump_of(depth[x], around(cells_, row, static_cast<int>(x / 2)));
    }
  }

 private:
  /// Pixels that differ from their own cell: few, and only these are worth looking around for.
  void find_candidates(const float* depth, int row) {
    const float* expected = cells_[row];
    const std::size_t columns = before_.size();
    for (std::size_t x = 0; x < columns; ++x) before_[x] = expected[x / 2];
    const float* before = before_.data();
    std::uint8_t* candidate = candidate_.data();
    const float base = base_, growth = growth_;
    // Only what came nearer, unless both are asked for. Without a branch, to run on vectors: a
    // missing depth (0) makes for no change here.
    const float away = config_.revealed ? -1.0F : 0.0F;
    for (std::size_t x = 0; x < columns; ++x) {
      const float z = depth[x];
      const float nearer = before[x] - z;
      const float change = std::min(std::max(nearer, away * nearer), z * kVeryLarge);
      candidate[x] = change > base + growth * z * z ? 1 : 0;
    }
  }

  [[nodiscard]] std::uint8_t jump_of(float z, const Nearest& expected) const {
    const float limit = base_ + growth_ * z * z;
    if (z < expected.min_m - limit) return kCameNearer;
    // Beside an edge, a strip comes into view because the camera moves: nothing is known of it.
    const bool seen_before = expected.known >= 7;
    const bool gone = config_.revealed && seen_before && z > expected.max_m + limit;
    return gone ? kWentFarther : kNoJump;
  }

  const cv::Mat1f& cells_;
  const DepthJumpConfig& config_;
  float base_, growth_;
  std::vector<float> before_;            // the cells' depth, for each pixel
  std::vector<std::uint8_t> candidate_;  // and eight more
};

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

void WarpedDepth::fill_from(const WarpedDepth& other) {
  if (mat.empty()) {
    mat = other.mat.clone();
    return;
  }
  for (int row = 0; row < mat.rows; ++row) {
    float* cell = mat[row];
    const float* known = other.mat[row];
    for (int c = 0; c < mat.cols; ++c) cell[c] = cell[c] > 0 ? cell[c] : known[c];
  }
}

DepthWarper::DepthWarper(const CameraModel& camera)
    : camera_(camera),
      ray_x_(cells_in(camera.height_px), cells_in(camera.width_px)),
      ray_y_(ray_x_.size()) {
  const cv::Mat2f rays = pixel_rays(camera);
  for (int row = 0; row < ray_x_.rows; ++row) {
    for (int c = 0; c < ray_x_.cols; ++c) {
      ray_x_(row, c) = rays(2 * row, 2 * c)[0];
      ray_y_(row, c) = rays(2 * row, 2 * c)[1];
    }
  }
}

WarpedDepth DepthWarper::warp(const DepthImage& previous,
                              const Eigen::Isometry3d& T_current_previous,
                              const cv::Mat1b& without) const {
  STILLMAP_CHECK(previous.mat.rows == camera_.height_px && previous.mat.cols == camera_.width_px);
  const Eigen::Matrix<float, 3, 4> T = T_current_previous.matrix().topRows<3>().cast<float>();
  WarpedDepth warped{cv::Mat1f(ray_x_.size(), 0.0F)};
  const auto columns = static_cast<float>(ray_x_.cols), rows = static_cast<float>(ray_x_.rows);
  const auto width = static_cast<std::size_t>(ray_x_.cols);
  std::vector<float> u(width), v(width), z(width), known(width);
  for (int row = 0; row < ray_x_.rows; ++row) {
    const float* depth = previous.mat[2 * row];
    for (std::size_t c = 0; c < width; ++c) z[c] = depth[2 * c];
    if (!without.empty()) {
      const std::uint8_t* left_out = without[2 * row];
      for (std::size_t c = 0; c < width; ++c) z[c] = left_out[2 * c] != 0 ? 0.0F : z[c];
    }
    std::ranges::copy(z, known.begin());
    project_row(T, ray_x_[row], ray_y_[row], {u.data(), v.data(), z.data(), width});
    for (std::size_t c = 0; c < width; ++c) {
      const bool inside = u[c] >= 0 && v[c] >= 0 && u[c] < columns && v[c] < rows;
      if (!inside || !(known[c] > 0) || !(z[c] > 0.01F)) continue;
      float& cell = warped.mat(static_cast<int>(v[c]), static_cast<int>(u[c]));
      if (cell == 0 || z[c] < cell) cell = z[c];
    }
  }
  return warped;
}

void DepthWarper::project_row(const Eigen::Matrix<float, 3, 4>& T,
                              const float* ray_x,
                              const float* ray_y,
                              const Row& row) const {
  const auto fx = static_cast<float>(camera_.fx / 2), fy = static_cast<float>(camera_.fy / 2);
  // A half more: to truncate is then to round to the nearest cell.
  const auto cx = static_cast<float>(camera_.cx / 2 + 0.5);
  const auto cy = static_cast<float>(camera_.cy / 2 + 0.5);
  const auto k1 = static_cast<float>(camera_.k1), k2 = static_cast<float>(camera_.k2);
  const auto k3 = static_cast<float>(camera_.k3);
  const auto p1 = static_cast<float>(camera_.p1), p2 = static_cast<float>(camera_.p2);
  const float a = T(0, 0), b = T(0, 1), c = T(0, 2), d = T(0, 3);
  const float e = T(1, 0), f = T(1, 1), g = T(1, 2), h = T(1, 3);
  const float i = T(2, 0), j = T(2, 1), k = T(2, 2), l = T(2, 3);
  for (std::size_t n = 0; n < row.size; ++n) {  // without a branch, so that it runs on vectors
    const float z = row.z[n];
    const float px = ray_x[n] * z, py = ray_y[n] * z;
    const float depth = i * px + j * py + k * z + l;
    const float x = (a * px + b * py + c * z + d) / depth;
    const float y = (e * px + f * py + g * z + h) / depth;
    const float r2 = x * x + y * y;
    const float radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    row.u[n] = fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx;
    row.v[n] = fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + cy;
    row.z[n] = depth;
  }
}

cv::Mat1b depth_jumps(const DepthImage& current,
                      const WarpedDepth& expected,
                      const DepthJumpConfig& config) {
  const cv::Mat1f& cells = expected.mat;
  STILLMAP_CHECK(cells.rows == cells_in(current.mat.rows) &&
                 cells.cols == cells_in(current.mat.cols));
  cv::Mat1b jumps(current.mat.size(), std::uint8_t{kNoJump});
  JumpFinder finder(cells, config, jumps.cols);
  for (int y = 0; y < jumps.rows; ++y) finder.mark(current.mat[y], y / 2, jumps[y]);
  return jumps;
}

}  // namespace stillmap
