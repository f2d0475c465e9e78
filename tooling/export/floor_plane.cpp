// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/floor_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "stillmap/core/error.hpp"
#include "stillmap/core/random.hpp"
#include "stillmap/dense/voxel_grid.hpp"
#include "stillmap/geometry/ransac.hpp"
#include "tooling/export/voxel_walk.hpp"

namespace stillmap {
namespace {

constexpr double kThinnedM = 0.05;  // so that points count surface, not how often it was seen
constexpr double kAreaCellM = 0.1;
constexpr std::size_t kMinAreaCells = 50;  // half a square metre
constexpr double kPatchM = 0.2;
constexpr std::size_t kMinPatchPoints = 6;
constexpr double kMaxPatchRoughness = 0.25;  // variance across it, by the lesser one along it
constexpr double kMinPatchCosine = 0.9;      // 26 degrees between a patch and its plane
constexpr double kInlierM = 0.03;
constexpr double kBelowM = 0.10;
constexpr double kMaxShareBelow = 0.05;
constexpr double kMinCameraHeightM = 0.2;
constexpr double kMinUpCosine = 0.642787609686539;  // 50 degrees
constexpr int kDraws = 20000;
constexpr std::uint32_t kSample = 1000;  // points on which a draw is tried first
constexpr std::size_t kFinalists = 20;
constexpr int kRefinements = 5;

using Points = std::vector<Eigen::Vector3d>;

// What the cameras say of a plane: where up is, and that they are above it.
class CameraEvidence {
 public:
  explicit CameraEvidence(std::span<const Eigen::Isometry3d> T_world_camera)
      : T_world_camera_(T_world_camera) {
    for (const Eigen::Isometry3d& pose : T_world_camera) up_ -= pose.linear().col(1);
    up_.normalize();
  }

  /// Whether a surface with this normal, of either sign, can be floor at all.
  [[nodiscard]] bool may_be_level(const Eigen::Vector3d& normal) const {
    return std::abs(normal.dot(up_)) >= kMinUpCosine;
  }

  /// The plane with its normal up; nothing when it cannot be the floor.
  [[nodiscard]] std::optional<FloorPlane> as_floor(FloorPlane plane) const {
    if (plane.up.dot(up_) < 0) plane = {-plane.up, -plane.offset_m};
    if (!(plane.up.dot(up_) >= kMinUpCosine)) return std::nullopt;
    const bool above = std::ranges::all_of(T_world_camera_, [&](const Eigen::Isometry3d& pose) {
      return plane.height_m(pose.translation()) >= kMinCameraHeightM;
    });
    return above ? std::optional(plane) : std::nullopt;
  }

 private:
  std::span<const Eigen::Isometry3d> T_world_camera_;
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero();
};

/// The plane that fits points best, in the sense of least squares.
struct PlaneFit {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double roughness = 1.0;
};

PlaneFit fit_plane(const Points& points) {
  PlaneFit fit;
  for (const Eigen::Vector3d& p : points) fit.mean += p;
  fit.mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    scatter += (p - fit.mean) * (p - fit.mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  fit.normal = solver.eigenvectors().col(0);
  if (solver.eigenvalues()[1] > 0)
    fit.roughness = solver.eigenvalues()[0] / solver.eigenvalues()[1];
  return fit;
}

// The map in the view of who looks for a floor.
struct Surface {
  Points all;
  Points level;    // those on flat patches that may be floor
  Points normals;  // of their patches
};

// Whether a level point lies on the plane, and so does its patch.
bool is_on(const FloorPlane& plane, const Surface& surface, std::size_t i) {
  return std::abs(plane.height_m(surface.level[i])) <= kInlierM &&
         std::abs(plane.up.dot(surface.normals[i])) >= kMinPatchCosine;
}

bool too_much_below(const FloorPlane& plane, const Points& points) {
  const auto below = std::ranges::count_if(
      points, [&](const Eigen::Vector3d& p) { return plane.height_m(p) < -kBelowM; });
  return static_cast<double>(below) > kMaxShareBelow * static_cast<double>(points.size());
}

std::optional<FloorPlane> plane_through(const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b,
                                        const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.norm();
  if (area < 1e-3) return std::nullopt;
  return FloorPlane{normal / area, -normal.dot(a) / area};
}

FloorPlane refined(const FloorPlane& plane, const Surface& surface) {
  Points on;
  for (std::size_t i = 0; i < surface.level.size(); ++i) {
    if (is_on(plane, surface, i)) on.push_back(surface.level[i]);
  }
  if (on.size() < 3) return plane;
  const PlaneFit fit = fit_plane(on);
  const Eigen::Vector3d up = fit.normal.dot(plane.up) < 0 ? -fit.normal : fit.normal;
  return {up, -up.dot(fit.mean)};
}

// The plane's surface in cells with points in them and in all cells round them: the line where a
// wall ends, or where the plane cuts through one, has none.
std::size_t inner_cells(const FloorPlane& plane, const Surface& surface) {
  const Eigen::Vector3d u = plane.up.unitOrthogonal();
  const Eigen::Vector3d v = plane.up.cross(u);
  std::set<std::pair<int, int>> cells;
  for (std::size_t i = 0; i < surface.level.size(); ++i) {
    if (!is_on(plane, surface, i)) continue;
    const Eigen::Vector3d& p = surface.level[i];
    cells.emplace(static_cast<int>(std::floor(u.dot(p) / kAreaCellM)),
                  static_cast<int>(std::floor(v.dot(p) / kAreaCellM)));
  }
  const auto is_inner = [&](const std::pair<int, int>& cell) {
    for (int i = 0; i < 9; ++i) {
      if (!cells.contains({cell.first + i / 3 - 1, cell.second + i % 3 - 1})) return false;
    }
    return true;
  };
  return static_cast<std::size_t>(std::ranges::count_if(cells, is_inner));
}

Surface make_surface(std::span<const Eigen::Vector3f> p_world, const CameraEvidence& cameras) {
  Surface surface;
  for (const Eigen::Vector3f& p : thinned(p_world, kThinnedM)) {
    surface.all.push_back(p.cast<double>());
  }
  std::map<std::array<int, 3>, Points> patches;
  for (const Eigen::Vector3d& p : surface.all) {
    const Eigen::Vector3i voxel = voxel_of(p, kPatchM);
    patches[{voxel.x(), voxel.y(), voxel.z()}].push_back(p);
  }
  for (const auto& [voxel, points] : patches) {
    if (points.size() < kMinPatchPoints) continue;
    const PlaneFit fit = fit_plane(points);
    if (fit.roughness > kMaxPatchRoughness || !cameras.may_be_level(fit.normal)) continue;
    surface.level.insert(surface.level.end(), points.begin(), points.end());
    surface.normals.insert(surface.normals.end(), points.size(), fit.normal);
  }
  return surface;
}

struct Candidate {
  std::size_t support = 0;
  FloorPlane plane;
};

// Planes through three level points, those with the most of these on them first.
std::vector<Candidate> draw_candidates(const Surface& surface, const CameraEvidence& cameras) {
  std::mt19937 rng = rng_for(0, FrameId{0}, RandomPurpose::kFloorPlane);
  const auto draw = [&](const Points& points) {
    return draw_index(rng, static_cast<std::uint32_t>(points.size()));
  };
  Points part_of_all;
  std::vector<std::size_t> part_of_level;
  for (std::uint32_t i = 0; i < kSample; ++i) {
    part_of_all.push_back(surface.all[draw(surface.all)]);
    part_of_level.push_back(draw(surface.level));
  }
  std::vector<Candidate> candidates;
  for (int i = 0; i < kDraws; ++i) {
    const Sample<3> sample =
        draw_with_replacement<3>(rng, static_cast<std::uint32_t>(surface.level.size()));
    const std::optional<FloorPlane> plane =
        plane_through(surface.level[sample[0]], surface.level[sample[1]], surface.level[sample[2]]);
    const std::optional<FloorPlane> floor = plane ? cameras.as_floor(*plane) : std::nullopt;
    if (!floor || too_much_below(*floor, part_of_all)) continue;
    const auto on = std::ranges::count_if(
        part_of_level, [&](std::size_t level) { return is_on(*floor, surface, level); });
    candidates.push_back({static_cast<std::size_t>(on), *floor});
  }
  std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::support);
  candidates.resize(std::min(candidates.size(), kFinalists));
  return candidates;
}

}  // namespace

std::optional<FloorPlane> find_floor(std::span<const Eigen::Vector3f> p_world,
                                     std::span<const Eigen::Isometry3d> T_world_camera) {
  const CameraEvidence cameras(T_world_camera);
  const Surface surface = make_surface(p_world, cameras);
  if (surface.level.empty()) return std::nullopt;
  std::size_t most = 0;
  FloorPlane best;
  for (const Candidate& candidate : draw_candidates(surface, cameras)) {
    FloorPlane plane = candidate.plane;
    for (int i = 0; i < kRefinements; ++i) plane = refined(plane, surface);
    const std::optional<FloorPlane> floor = cameras.as_floor(plane);
    if (!floor || too_much_below(*floor, surface.all)) continue;
    const std::size_t area = inner_cells(*floor, surface);
    if (area > most) {
      most = area;
      best = *floor;
    }
  }
  return most >= kMinAreaCells ? std::optional(best) : std::nullopt;
}

Eigen::Isometry3d floor_frame(const FloorPlane& floor, const Eigen::Isometry3d& T_world_camera) {
  const auto along_floor = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v - floor.up.dot(v) * floor.up;
  };
  Eigen::Vector3d forward = along_floor(T_world_camera.linear().col(2));
  if (forward.norm() < 0.1) forward = along_floor(-T_world_camera.linear().col(1));
  Eigen::Isometry3d T_world_grid = Eigen::Isometry3d::Identity();
  T_world_grid.linear().col(0) = forward.normalized();
  T_world_grid.linear().col(1) = floor.up.cross(forward.normalized());
  T_world_grid.linear().col(2) = floor.up;
  const Eigen::Vector3d camera = T_world_camera.translation();
  T_world_grid.translation() = camera - floor.height_m(camera) * floor.up;
  return T_world_grid.inverse();
}

}  // namespace stillmap
