// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/scene_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace stillmap {
namespace {

constexpr double kPointSize = 2.0;  // in spacings: surfaces look closed
constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<Eigen::Vector3d> finite_points(const PointCloud& map, std::size_t at_most) {
  std::vector<Eigen::Vector3d> points;
  const std::size_t stride = map.size() / at_most + 1;
  for (std::size_t i = 0; i < map.size(); i += stride) {
    if (map.positions[i].allFinite()) points.push_back(map.positions[i].cast<double>());
  }
  return points;
}

// The box of the points without the outer 1 % at each end of each axis.
Eigen::AlignedBox3d inner_box(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  if (points.empty()) return box;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points) values.push_back(p[axis]);
    const auto outer = static_cast<std::ptrdiff_t>(values.size() / 100);
    std::nth_element(values.begin(), values.begin() + outer, values.end());
    low[axis] = values[values.size() / 100];
    std::nth_element(values.begin(), values.end() - 1 - outer, values.end());
    high[axis] = values[values.size() - 1 - values.size() / 100];
  }
  box.extend(low);
  box.extend(high);
  return box;
}

// The concentration of heights along `down`: the sum of squares of a histogram's counts.
double height_concentration(const std::vector<Eigen::Vector3d>& points,
                            const Eigen::Vector3d& down) {
  constexpr double kBin_m = 0.04;
  constexpr std::uint32_t kBins =
      4096;  // heights that lie 164 m apart share one, which does no harm
  constexpr double kAboveZero = 1U << 30U;  // so that a conversion rounds down
  const Eigen::Vector3d down_bins = down / kBin_m;
  std::array<std::uint32_t, kBins> counts{};
  for (const Eigen::Vector3d& p : points) {
    const double bin = std::clamp(p.dot(down_bins) + kAboveZero, 0.0, 2 * kAboveZero);
    ++counts[static_cast<std::uint32_t>(static_cast<std::int64_t>(bin)) % kBins];
  }
  double sum = 0;
  for (const std::uint32_t count : counts) sum += static_cast<double>(count) * count;
  return sum;
}

struct Tilt {
  double x = 0, z = 0;  // radians
  double score = -1;
};

Tilt best_tilt(const std::vector<Eigen::Vector3d>& points,
               const Eigen::Matrix3d& R_world_rough,
               const Tilt& around,
               double step) {
  Tilt best = around;
  for (int i = -15; i <= 15; ++i) {
    for (int k = -15; k <= 15; ++k) {
      const double x = around.x + i * step;
      const double z = around.z + k * step;
      const Eigen::Vector3d down = Eigen::Vector3d(std::sin(z), 1, std::sin(x)).normalized();
      const double score = height_concentration(points, R_world_rough * down);
      if (score > best.score) best = {x, z, score};
    }
  }
  return best;
}

Eigen::Matrix3d axes_from(const Eigen::Vector3d& down, const Eigen::Vector3d& forward) {
  Eigen::Vector3d right = down.cross(forward);
  if (right.norm() < 1e-6) right = down.unitOrthogonal();
  right.normalize();
  Eigen::Matrix3d R_world_axes;
  R_world_axes << right, down, right.cross(down);
  return R_world_axes;
}

Eigen::Matrix3d level_rotation(const std::vector<Eigen::Vector3d>& points,
                               const Trajectory& cameras,
                               const std::optional<Eigen::Vector3d>& up_world) {
  Eigen::Vector3d down = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : cameras) {
    down += pose.T_world_camera.linear().col(1);
    forward += pose.T_world_camera.linear().col(2);
  }
  if (!(down.norm() > 1e-6)) down = Eigen::Vector3d::UnitY();
  if (!(forward.norm() > 1e-6)) forward = Eigen::Vector3d::UnitZ();
  if (up_world) return axes_from(-up_world->normalized(), forward.normalized()).transpose();
  const Eigen::Matrix3d R_world_rough = axes_from(down.normalized(), forward);
  const Tilt coarse = best_tilt(points, R_world_rough, Tilt{}, 3 * kDegree);
  const Tilt fine = best_tilt(points, R_world_rough, coarse, 0.2 * kDegree);
  const Eigen::Vector3d level = Eigen::Vector3d(std::sin(fine.z), 1, std::sin(fine.x)).normalized();
  return axes_from(R_world_rough * level, forward).transpose();
}

// From the area that the points cover, counted in voxels.
double typical_spacing(const std::vector<Eigen::Vector3d>& points, const Eigen::AlignedBox3d& box) {
  constexpr double kVoxel_m = 0.05;
  std::vector<std::uint64_t> voxels;
  std::size_t inside = 0;
  for (const Eigen::Vector3d& p : points) {
    if (!box.contains(p) || box.sizes().maxCoeff() > 1e4) continue;
    const Eigen::Array3d cell = ((p - box.min()) / kVoxel_m).array().floor();
    const std::uint64_t x = static_cast<std::uint64_t>(cell.x());
    const std::uint64_t y = static_cast<std::uint64_t>(cell.y());
    voxels.push_back((x << 40U) | (y << 20U) | static_cast<std::uint64_t>(cell.z()));
    ++inside;
  }
  if (inside == 0) return 0.01;
  std::sort(voxels.begin(), voxels.end());
  const std::ptrdiff_t count = std::unique(voxels.begin(), voxels.end()) - voxels.begin();
  // A plane of area A touches about 1.5 A / voxel^2 voxels.
  const double area = static_cast<double>(count) * kVoxel_m * kVoxel_m / 1.5;
  return std::clamp(std::sqrt(area / static_cast<double>(inside)), 0.002, 0.1);
}

}  // namespace

SceneFrame scene_frame(const PointCloud& map,
                       const Trajectory& cameras,
                       const std::optional<Eigen::Vector3d>& up_world) {
  SceneFrame scene;
  scene.R_level_world = level_rotation(finite_points(map, 4000), cameras, up_world);
  std::vector<Eigen::Vector3d> points = finite_points(map, 2'000'000);
  for (Eigen::Vector3d& p : points) p = scene.R_level_world * p;
  scene.box = inner_box(points);
  scene.spacing_m = typical_spacing(points, scene.box);
  for (const StampedPose& pose : cameras) {
    scene.cameras.extend(scene.R_level_world * pose.T_world_camera.translation());
  }
  return scene;
}

std::vector<std::size_t> points_in_scene(const PointCloud& map, const SceneFrame& scene) {
  std::vector<std::size_t> inside;
  if (scene.box.isEmpty()) return inside;
  const Eigen::Vector3d margin = 0.5 * scene.box.sizes() + Eigen::Vector3d::Constant(0.5);
  const Eigen::AlignedBox3d wide(scene.box.min() - margin, scene.box.max() + margin);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d p = map.positions[i].cast<double>();
    if (p.allFinite() && wide.contains(scene.R_level_world * p)) inside.push_back(i);
  }
  return inside;
}

View view_turned(const SceneFrame& scene, const GazeTurn& turn, int width_px, int height_px) {
  View view;
  view.width_px = width_px;
  view.height_px = height_px;
  view.scale = 1.1 * height_px;
  view.point_size_m = kPointSize * scene.spacing_m;
  if (scene.box.isEmpty()) return view;
  const Eigen::AlignedBox3d box = scene.box.merged(scene.cameras);
  const Eigen::Vector3d target = box.center();
  const Eigen::Vector3d ahead(std::sin(turn.right), 0, std::cos(turn.right));
  const Eigen::Vector3d right(std::cos(turn.right), 0, -std::sin(turn.right));
  const Eigen::Vector3d forward =
      std::cos(turn.down) * ahead + std::sin(turn.down) * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d down =
      std::cos(turn.down) * Eigen::Vector3d::UnitY() - std::sin(turn.down) * ahead;
  // As near as possible with all corners of the box in the picture; then slightly nearer, as
  // corners are mostly empty.
  double distance = 0.5;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner =
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)) - target;
    const double aside = std::abs(corner.dot(right)) / (0.5 * width_px);
    const double below = std::abs(corner.dot(down)) / (0.5 * height_px);
    distance = std::max(distance, view.scale * std::max(aside, below) - corner.dot(forward));
  }
  const Eigen::Vector3d eye = target - 0.82 * distance * forward;
  const Eigen::Matrix3d R_world_level = scene.R_level_world.transpose();
  view.T_camera_world = look_at(
      R_world_level * eye, R_world_level * target, R_world_level * Eigen::Vector3d::UnitY());
  return view;
}

View view_along(const SceneFrame& scene, int width_px, int height_px) {
  return view_turned(scene, {.right = 0, .down = 25 * kDegree}, width_px, height_px);
}

double head_height(const SceneFrame& scene) {
  constexpr double kHeadroom_m = 0.4;
  if (!scene.cameras.isEmpty()) return scene.cameras.center().y() - kHeadroom_m;
  return scene.box.isEmpty() ? 0.0 : scene.box.min().y() - kHeadroom_m;
}

SceneLayout scene_layout(const SceneFrame& scene) {
  return {.R_level_world = scene.R_level_world,
          .box = scene.box.isEmpty() ? scene.box : scene.box.merged(scene.cameras),
          .head_y = head_height(scene),
          .spacing_m = scene.spacing_m};
}

View view_from_above(const SceneFrame& scene, int width_px, int height_px) {
  constexpr double kEyeHeight_m = 10;
  View view;
  view.width_px = width_px;
  view.height_px = height_px;
  view.orthographic = true;
  view.point_size_m = kPointSize * scene.spacing_m;
  if (scene.box.isEmpty()) return view;
  const Eigen::AlignedBox3d box = scene.box.merged(scene.cameras);
  const Eigen::Vector3d sizes = box.sizes().cwiseMax(0.1);
  view.scale = 0.92 * std::min(width_px / sizes.x(), height_px / sizes.z());
  view.near_m = kEyeHeight_m;
  Eigen::Vector3d eye = box.center();
  eye.y() = head_height(scene) - kEyeHeight_m;
  const Eigen::Matrix3d R_world_level = scene.R_level_world.transpose();
  view.T_camera_world = look_at(R_world_level * eye,
                                R_world_level * (eye + Eigen::Vector3d::UnitY()),
                                R_world_level * -Eigen::Vector3d::UnitZ());
  return view;
}

}  // namespace stillmap
