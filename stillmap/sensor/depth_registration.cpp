// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/depth_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/lens.hpp"

namespace stillmap {
namespace {

// Neighbouring pixels are on one surface where their depths differ by less than this share. A wall
// seen at 80 degrees from its normal differs by half of that from pixel to pixel.
constexpr float kSameSurface = 0.04F;
constexpr float kNearestM = 0.05F;   // from the color camera
constexpr float kLargestPx = 64.0F;  // a larger square comes from a point beside the color camera

/// A position in the color image, with the inverse of its depth, which is linear on a plane.
struct Vertex {
  float u, v, inverse_z;
};

/// The surface that a depth pixel saw.
struct Square {
  Vertex center;
  std::array<Vertex, 4> corners;  // left above, right above, right below, left below
};

/// Projects points of the color camera's frame to raw pixels.
class ColorProjection {
 public:
  explicit ColorProjection(const CameraModel& camera)
      : fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)),
        cx_(static_cast<float>(camera.cx)),
        cy_(static_cast<float>(camera.cy)),
        lens_(camera.lens == LensModel::kFisheye ? Lens(FisheyeLens<float>(camera))
                                                 : Lens(BrownConradyLens<float>(camera))) {}

  [[nodiscard]] Vertex operator()(const Eigen::Vector3f& p) const {
    const float inverse_z = 1.0F / p.z();
    const LensPoint<float> at = std::visit(
        [&](const auto& lens) { return lens(p.x() * inverse_z, p.y() * inverse_z); }, lens_);
    return {fx_ * at.x + cx_, fy_ * at.y + cy_, inverse_z};
  }

 private:
  using Lens = std::variant<BrownConradyLens<float>, FisheyeLens<float>>;
  float fx_, fy_, cx_, cy_;
  Lens lens_;
};

/// The depth of a pixel's corner: on the surface that the pixel shares with its neighbours there.
/// (column, row) is the pixel, (right, below) which corner, 0 or 1 each.
float corner_depth(const cv::Mat1f& depth, cv::Point pixel, int right, int below) {
  const float z = depth(pixel);
  float sum = 0;
  int count = 0;
  for (int row = pixel.y + below - 1; row <= pixel.y + below; ++row) {
    if (row < 0 || row >= depth.rows) continue;
    for (int column = pixel.x + right - 1; column <= pixel.x + right; ++column) {
      if (column < 0 || column >= depth.cols) continue;
      const float other = depth(row, column);
      if (!(other > 0) || std::abs(other - z) > kSameSurface * z) continue;
      sum += 1.0F / other;
      ++count;
    }
  }
  return static_cast<float>(count) / sum;
}

/// Draws a triangle into an image of inverse depths, the greatest in front. Borders are drawn by
/// both neighbours, so that no pixel between them is left out.
void draw_triangle(const Vertex& a, const Vertex& b, const Vertex& c, cv::Mat1f& inverse) {
  const float area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  if (!(std::abs(area) > 1e-9F)) return;
  const auto first = [](float least) { return std::max(0, static_cast<int>(std::ceil(least))); };
  const auto last = [](float greatest, int size) {
    return std::min(size - 1, static_cast<int>(std::floor(greatest)));
  };
  const int right = last(std::max({a.u, b.u, c.u}), inverse.cols);
  const int bottom = last(std::max({a.v, b.v, c.v}), inverse.rows);
  for (int row = first(std::min({a.v, b.v, c.v})); row <= bottom; ++row) {
    for (int column = first(std::min({a.u, b.u, c.u})); column <= right; ++column) {
      const auto u = static_cast<float>(column), v = static_cast<float>(row);
      const float of_a = ((b.u - u) * (c.v - v) - (b.v - v) * (c.u - u)) / area;
      const float of_b = ((c.u - u) * (a.v - v) - (c.v - v) * (a.u - u)) / area;
      const float of_c = 1.0F - of_a - of_b;
      constexpr float kInside = -1e-4F;
      if (of_a < kInside || of_b < kInside || of_c < kInside) continue;
      const float here = of_a * a.inverse_z + of_b * b.inverse_z + of_c * c.inverse_z;
      inverse(row, column) = std::max(inverse(row, column), here);
    }
  }
}

void draw(const Square& square, cv::Mat1f& inverse) {
  for (std::size_t i = 0; i < square.corners.size(); ++i) {
    const std::size_t next = (i + 1) % square.corners.size();
    draw_triangle(square.center, square.corners[i], square.corners[next], inverse);
  }
}

/// Whether a square can be in the image, is in front of the camera, and is not too large.
bool drawable(const Square& square, cv::Size image) {
  const auto& corners = square.corners;
  const auto [left, right] = std::ranges::minmax(corners, {}, &Vertex::u);
  const auto [top, bottom] = std::ranges::minmax(corners, {}, &Vertex::v);
  const auto [farthest, nearest] = std::ranges::minmax(corners, {}, &Vertex::inverse_z);
  const bool in_front = farthest.inverse_z > 0 && square.center.inverse_z > 0 &&
                        std::max(nearest.inverse_z, square.center.inverse_z) < 1.0F / kNearestM;
  const bool small = right.u - left.u < kLargestPx && bottom.v - top.v < kLargestPx;
  return in_front && small && right.u >= 0 && bottom.v >= 0 &&
         left.u <= static_cast<float>(image.width) && top.v <= static_cast<float>(image.height);
}

}  // namespace

DepthRegistration::DepthRegistration(const CameraModel& camera) : color_(camera) {
  STILLMAP_CHECK(camera.depth_camera != nullptr);
  const DepthCamera& depth = *camera.depth_camera;
  T_color_depth_ = depth.T_color_depth.cast<float>();
  rays_ = pixel_rays(depth.camera);
  CameraModel corners = depth.camera;  // whose pixels are centered at the corners
  ++corners.width_px;
  ++corners.height_px;
  corners.cx += 0.5;
  corners.cy += 0.5;
  corner_rays_ = pixel_rays(corners);
}

DepthImage DepthRegistration::to_color(const DepthImage& depth) const {
  const cv::Mat1f& from = depth.mat;
  STILLMAP_CHECK(from.rows == rays_.rows && from.cols == rays_.cols);
  const ColorProjection project(color_);
  const auto project_at = [&](const cv::Vec2f& ray, float z) {
    return project(T_color_depth_ * Eigen::Vector3f(ray[0] * z, ray[1] * z, z));
  };
  cv::Mat1f inverse(color_.height_px, color_.width_px, 0.0F);
  // Right and below, or not, in the order of a square.
  constexpr std::array<std::pair<int, int>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (int row = 0; row < from.rows; ++row) {
    for (int column = 0; column < from.cols; ++column) {
      const float z = from(row, column);
      if (!(z > 0)) continue;
      Square square{};
      square.center = project_at(rays_(row, column), z);
      for (std::size_t i = 0; i < kCorners.size(); ++i) {
        const auto& [right, below] = kCorners[i];
        square.corners[i] = project_at(corner_rays_(row + below, column + right),
                                       corner_depth(from, {column, row}, right, below));
      }
      if (drawable(square, inverse.size())) draw(square, inverse);
    }
  }
  for (float& value : inverse) value = value > 0 ? 1.0F / value : 0.0F;
  return DepthImage(inverse);
}

}  // namespace stillmap
