// SPDX-License-Identifier: Apache-2.0
#include "stillmap/formats/floor_plane.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "stillmap/cloud/voxel_grid.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/random.hpp"

namespace stillmap {
namespace {

constexpr double kThinnedM = 0.05;  // so that points count surface, not how often it was seen
constexpr double kAreaCellM = 0.1;
constexpr std::size_t kMinAreaCells = 50;  // half a square metre
constexpr double kInlierM = 0.03;
constexpr double kBelowM = 0.10;
constexpr double kMaxShareBelow = 0.05;
constexpr double kMinCameraHeightM = 0.2;
constexpr double kMinUpCosine = 0.642787609686539;  // 50 degrees
constexpr int kDraws = 20000;
constexpr std::uint32_t kSample = 2000;  // points on which a draw is tried first
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

// How many points lie on the plane; 0 when too many lie below it.
std::size_t support(const FloorPlane& plane, std::span<const Eigen::Vector3d> points) {
  std::size_t on = 0;
  std::size_t below = 0;
  for (const Eigen::Vector3d& p : points) {
    const double height = plane.height_m(p);
    if (std::abs(height) <= kInlierM) ++on;
    if (height < -kBelowM) ++below;
  }
  const double allowed = kMaxShareBelow * static_cast<double>(points.size());
  return static_cast<double>(below) <= allowed ? on : 0;
}

std::optional<FloorPlane> plane_through(const Eigen::Vector3d& a,
                                        const Eigen::Vector3d& b,
                                        const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.norm();
  if (area < 1e-3) return std::nullopt;
  return FloorPlane{normal / area, -normal.dot(a) / area};
}

FloorPlane fitted(const FloorPlane& plane, const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Points on;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height_m(p)) > kInlierM) continue;
    on.push_back(p);
    mean += p;
  }
  if (on.size() < 3) return plane;
  mean /= static_cast<double>(on.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : on) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Eigen::Vector3d up = solver.eigenvectors().col(0);
  if (up.dot(plane.up) < 0) up = -up;
  return {up, -up.dot(mean)};
}

// The plane's surface in cells with points in them and in all cells round them: the line where a
// wall ends, or where the plane cuts through one, has none.
std::size_t inner_cells(const FloorPlane& plane, const Points& points) {
  const Eigen::Vector3d u = plane.up.unitOrthogonal();
  const Eigen::Vector3d v = plane.up.cross(u);
  std::set<std::pair<int, int>> cells;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height_m(p)) > kInlierM) continue;
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

struct Candidate {
  std::size_t support = 0;
  FloorPlane plane;
};

Points thinned(std::span<const Eigen::Vector3f> p_world) {
  VoxelGrid grid(kThinnedM);
  for (const Eigen::Vector3f& p : p_world) grid.add(p, Rgb{});
  Points points;
  for (const Eigen::Vector3f& p : grid.extract().positions) points.push_back(p.cast<double>());
  return points;
}

// The draws that do best on a part of the points, the best first.
std::vector<Candidate> draw_candidates(const Points& points, const CameraEvidence& cameras) {
  std::mt19937 rng = rng_for(0, FrameId{0}, RandomPurpose::kFloorPlane);
  const std::uint32_t count = static_cast<std::uint32_t>(points.size());
  const auto draw = [&]() -> const Eigen::Vector3d& { return points[draw_index(rng, count)]; };
  Points sample;
  for (std::uint32_t i = 0; i < std::min(kSample, count); ++i) sample.push_back(draw());
  std::vector<Candidate> candidates;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d& a = draw();
    const Eigen::Vector3d& b = draw();
    const std::optional<FloorPlane> plane = plane_through(a, b, draw());
    const std::optional<FloorPlane> floor = plane ? cameras.as_floor(*plane) : std::nullopt;
    if (floor) candidates.push_back({support(*floor, sample), *floor});
  }
  std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::support);
  candidates.resize(std::min(candidates.size(), kFinalists));
  return candidates;
}

}  // namespace

std::optional<FloorPlane> find_floor(std::span<const Eigen::Vector3f> p_world,
                                     std::span<const Eigen::Isometry3d> T_world_camera) {
  const Points points = thinned(p_world);
  if (points.empty() || T_world_camera.empty()) return std::nullopt;
  const CameraEvidence cameras(T_world_camera);
  std::size_t most = 0;
  FloorPlane best;
  for (const Candidate& candidate : draw_candidates(points, cameras)) {
    FloorPlane plane = candidate.plane;
    for (int i = 0; i < kRefinements; ++i) plane = fitted(plane, points);
    const std::optional<FloorPlane> floor = cameras.as_floor(plane);
    const std::size_t area =
        floor && support(*floor, points) > 0 ? inner_cells(*floor, points) : std::size_t{0};
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
