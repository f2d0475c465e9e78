// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/depth_jump.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/core/vector_clones.hpp"
#include "stillmap/geometry/lens.hpp"

namespace stillmap {
namespace {

int cells_in(int pixels) {
  return (pixels + 1) / 2;
}

constexpr float kNearest = 0.01F;  // metres; nearer depth is not warped
constexpr float kNothingNear = 1e9F;
constexpr int kEnoughKnown = 7;  // of nine cells

/// For each known cell the least depth of the 3x3 cells around it; 0 for the others.
cv::Mat1f least_around(const cv::Mat1f& cells) {
  cv::Mat1f known(cells.size()), least;
  for (int row = 0; row < cells.rows; ++row) {
    const float* z = cells[row];
    float* target = known[row];
    for (int c = 0; c < cells.cols; ++c) target[c] = z[c] > 0 ? z[c] : kNothingNear;
  }
  cv::erode(known, least, cv::Mat());
  for (int row = 0; row < cells.rows; ++row) {
    const float* z = cells[row];
    float* target = least[row];
    for (int c = 0; c < cells.cols; ++c) target[c] = z[c] > 0 ? target[c] : 0.0F;
  }
  return least;
}

/// The greatest depth of the 3x3 cells around one; nothing where few are known. Beside an edge, the
/// camera's motion reveals a strip of which no depth is known.
std::optional<float> greatest_around(const cv::Mat1f& cells, int row, int column) {
  float greatest = 0;
  int known = 0;
  for (int r = std::max(0, row - 1); r <= std::min(cells.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(cells.cols - 1, column + 1); ++c) {
      greatest = std::max(greatest, cells(r, c));
      known += cells(r, c) > 0 ? 1 : 0;
    }
  }
  return known >= kEnoughKnown ? std::optional(greatest) : std::nullopt;
}

/// The least change of depth that is a jump.
struct JumpLimit {
  float base_m, per_m;
  [[nodiscard]] float at(float z) const { return base_m + per_m * z * z; }
};

/// Marks the pixels of a row that are nearer than `least`, one value for two pixels. Branch-free,
/// so that it vectorises.
STILLMAP_VECTOR_CLONES
void mark_nearer(std::span<const float> depth,
                 const float* least,
                 const JumpLimit& limit,
                 std::uint8_t* jumps) {
  const std::size_t cells = depth.size() / 2;
  for (std::size_t c = 0; c < cells; ++c) {
    const float z0 = depth[2 * c], z1 = depth[2 * c + 1];
    const bool near0 = z0 > 0, near1 = z1 > 0;
    jumps[2 * c] = near0 & (z0 < least[c] - limit.at(z0)) ? kCameNearer : kNoJump;
    jumps[2 * c + 1] = near1 & (z1 < least[c] - limit.at(z1)) ? kCameNearer : kNoJump;
  }
  if (depth.size() % 2 == 0) return;
  const float z = depth.back();
  jumps[depth.size() - 1] = z > 0 && z < least[cells] - limit.at(z) ? kCameNearer : kNoJump;
}

/// Marks the pixels of a row that are farther than all cells around.
void mark_revealed(std::span<const float> depth,
                   const cv::Mat1f& cells,
                   int row,
                   const JumpLimit& limit,
                   std::uint8_t* jumps) {
  for (std::size_t x = 0; x < depth.size(); ++x) {
    const int column = static_cast<int>(x / 2);
    const float z = depth[x], before = cells(row, column);
    if (!(before > 0) || !(z - before > limit.at(z))) continue;
    const std::optional<float> greatest = greatest_around(cells, row, column);
    if (greatest && z > *greatest + limit.at(z)) jumps[x] = kWentFarther;
  }
}

}  // namespace

JumpImage depth_jumps(const DepthImage& current, const DepthImage& previous, double jump_m) {
  STILLMAP_CHECK(current.mat.size() == previous.mat.size());
  cv::Mat1b jumps(current.mat.size());
  const auto limit = static_cast<float>(jump_m);
  for (int row = 0; row < jumps.rows; ++row) {
    const float* now = current.mat[row];
    const float* before = previous.mat[row];
    std::uint8_t* jump = jumps[row];
    for (int x = 0; x < jumps.cols; ++x) {
      const bool nearer = before[x] - now[x] > limit;
      const bool farther = now[x] - before[x] > limit;
      jump[x] = static_cast<std::uint8_t>(
          now[x] > 0 ? (nearer ? kCameNearer : 0) + (farther ? kWentFarther : 0) : 0);
    }
  }
  return JumpImage(jumps);
}

HalfDepth filled_from(HalfDepth depth, const HalfDepth& other) {
  if (depth.empty()) return HalfDepth(other.mat.clone());
  for (int row = 0; row < depth.mat.rows; ++row) {
    float* cell = depth.mat[row];
    const float* known = other.mat[row];
    for (int c = 0; c < depth.mat.cols; ++c) cell[c] = cell[c] > 0 ? cell[c] : known[c];
  }
  return depth;
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

HalfDepth DepthWarper::warp(const DepthImage& previous,
                            const Eigen::Isometry3d& T_current_previous,
                            const Mask& excluded) const {
  STILLMAP_CHECK(previous.mat.rows == camera_.height_px && previous.mat.cols == camera_.width_px);
  const Eigen::Matrix<float, 3, 4> T = T_current_previous.matrix().topRows<3>().cast<float>();
  const auto width = static_cast<std::size_t>(ray_x_.cols);
  std::vector<float> nearest(ray_x_.total() + 1, kNothingNear);  // one more: no cell
  std::vector<float> z(width);
  std::vector<std::int32_t> cells(width);
  for (int row = 0; row < ray_x_.rows; ++row) {
    const float* depth = previous.mat[2 * row];
    for (std::size_t c = 0; c < width; ++c) z[c] = depth[2 * c];
    if (!excluded.empty()) {
      const std::uint8_t* left_out = excluded.mat[2 * row];
      for (std::size_t c = 0; c < width; ++c) z[c] = left_out[2 * c] != 0 ? 0.0F : z[c];
    }
    project_row(T, ray_x_[row], ray_y_[row], {cells.data(), z.data(), width});
    for (std::size_t c = 0; c < width; ++c) {
      float& cell = nearest[static_cast<std::size_t>(cells[c])];
      cell = std::min(cell, z[c]);
    }
  }
  HalfDepth warped{cv::Mat1f(ray_x_.size())};
  std::ranges::transform(nearest.begin(), nearest.end() - 1, warped.mat[0], [](float m) {
    return m < kNothingNear ? m : 0.0F;
  });
  return warped;
}

// Inlined into the versions of project_row for several processors.
template <class Lens>
[[gnu::always_inline]] inline void DepthWarper::project_row_with(
    const Lens lens,
    const Eigen::Matrix<float, 3, 4>& T,
    const float* ray_x,
    const float* ray_y,
    const Row& row) const {
  const auto fx = static_cast<float>(camera_.fx / 2), fy = static_cast<float>(camera_.fy / 2);
  // Adding a half makes truncation round to the nearest cell.
  const auto cx = static_cast<float>(camera_.cx / 2 + 0.5);
  const auto cy = static_cast<float>(camera_.cy / 2 + 0.5);
  const float a = T(0, 0), b = T(0, 1), c = T(0, 2), d = T(0, 3);
  const float e = T(1, 0), f = T(1, 1), g = T(1, 2), h = T(1, 3);
  const float i = T(2, 0), j = T(2, 1), k = T(2, 2), l = T(2, 3);
  const auto columns = static_cast<float>(ray_x_.cols), rows = static_cast<float>(ray_x_.rows);
  const std::int32_t stride = ray_x_.cols, none = stride * ray_x_.rows;
  for (std::size_t n = 0; n < row.size; ++n) {  // branch-free, so that it vectorises
    const float z = row.z[n];
    const float px = ray_x[n] * z, py = ray_y[n] * z;
    const float depth = i * px + j * py + k * z + l;
    const float x = (a * px + b * py + c * z + d) / depth;
    const float y = (e * px + f * py + g * z + h) / depth;
    const LensPoint<float> at = lens(x, y);
    const float u = fx * at.x + cx;
    const float v = fy * at.y + cy;
    const bool inside = (u >= 0) & (v >= 0) & (u < columns) & (v < rows);
    const bool good = inside & (z > 0) & (depth > kNearest);
    const auto left = static_cast<std::int32_t>(good ? u : 0.0F);
    const auto top = static_cast<std::int32_t>(good ? v : 0.0F);
    row.cell[n] = good ? top * stride + left : none;
    row.z[n] = depth;
  }
}

STILLMAP_VECTOR_CLONES
void DepthWarper::project_row(const Eigen::Matrix<float, 3, 4>& T,
                              const float* ray_x,
                              const float* ray_y,
                              const Row& row) const {
  if (camera_.lens == LensModel::kFisheye) {
    project_row_with(FisheyeLens<float>(camera_), T, ray_x, ray_y, row);
  } else {
    project_row_with(BrownConradyLens<float>(camera_), T, ray_x, ray_y, row);
  }
}

JumpImage depth_jumps(const DepthImage& current,
                      const HalfDepth& expected,
                      const DepthJumpConfig& config) {
  const cv::Mat1f& cells = expected.mat;
  STILLMAP_CHECK(cells.rows == cells_in(current.mat.rows) &&
                 cells.cols == cells_in(current.mat.cols));
  cv::Mat1b jumps(current.mat.size());
  const JumpLimit limit{static_cast<float>(config.jump_m), static_cast<float>(config.jump_per_m)};
  const cv::Mat1f least = least_around(cells);
  const auto columns = static_cast<std::size_t>(jumps.cols);
  for (int y = 0; y < jumps.rows; ++y) {
    const std::span<const float> depth(current.mat[y], columns);
    mark_nearer(depth, least[y / 2], limit, jumps[y]);
    if (config.revealed) mark_revealed(depth, cells, y / 2, limit, jumps[y]);
  }
  return JumpImage(jumps);
}

}  // namespace stillmap
