// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/observed_space.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/voxel_grid.hpp"
#include "tooling/export/visible_points.hpp"
#include "tooling/export/voxel_blocks.hpp"
#include "tooling/export/voxel_walk.hpp"

namespace stillmap {
namespace {

constexpr double kMaxVoxelsFromOrigin = 32768;
constexpr std::size_t kMaxBlocks = std::size_t{1} << 15U;

struct VoxelEvidence {
  std::uint16_t points = 0;
  std::uint16_t views = 0;
  std::uint32_t last_view = 0;  // number of the last view that was counted, from 1
  std::uint32_t last_ray = 0;   // number of the last view with a ray through this voxel
};

void check_reach(const Eigen::Vector3d& p, double resolution_m) {
  const double farthest = p.cwiseAbs().maxCoeff();
  if (farthest < kMaxVoxelsFromOrigin * resolution_m) return;
  throw ResolutionError(
      "{:.6g} m from the origin is too far for voxels of {} m; choose larger ones",
      farthest,
      resolution_m);
}

class SpaceObserver {
 public:
  SpaceObserver(std::vector<Eigen::Vector3f> points, const SpaceOptions& options)
      : points_(std::move(points)), options_(options) {
    for (const Eigen::Vector3f& p : points_) {
      ++evidence_.at(voxel_of(p.cast<double>(), options_.resolution_m)).points;
      check_size();
    }
  }

  void add_view(const Eigen::Isometry3d& T_world_camera, const CameraModel& camera) {
    ++view_;
    check_reach(T_world_camera.translation(), options_.resolution_m);
    // The margin only selects rays; a ray ends at the first occupied voxel anyway.
    const VisibilityOptions visibility = {.point_radius_m = 0.375 * options_.resolution_m,
                                          .margin_m = 4 * options_.resolution_m};
    for (const std::uint32_t i : visible_points(points_, T_world_camera, camera, visibility)) {
      const Eigen::Vector3d p = points_[i].cast<double>();
      VoxelEvidence& end = evidence_.at(voxel_of(p, options_.resolution_m));
      if (end.last_ray == view_) continue;  // one ray per voxel is enough
      end.last_ray = view_;
      cast(T_world_camera.translation(), p);
    }
  }

  [[nodiscard]] ObservedSpace take() const {
    ObservedSpace space{.resolution_m = options_.resolution_m, .voxels = {}};
    evidence_.for_each([&](const Eigen::Vector3i& index, const VoxelEvidence& evidence) {
      if (evidence.points == 0 && evidence.views == 0) return;
      space.voxels.push_back({index, evidence.points, evidence.views});
    });
    return space;
  }

 private:
  void cast(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double length = (to - from).norm();
    const bool too_far = length > options_.max_range_m;
    const Eigen::Vector3d end = too_far ? from + (options_.max_range_m / length) * (to - from) : to;
    const Eigen::Vector3i start = voxel_of(from, options_.resolution_m);
    for (VoxelWalk walk(from, end, options_.resolution_m);; walk.advance()) {
      VoxelEvidence& evidence = evidence_.at(walk.voxel());
      if (evidence.last_view != view_) {
        evidence.last_view = view_;
        if (evidence.views < UINT16_MAX) ++evidence.views;
      }
      const bool blocked = evidence.points > 0 && walk.voxel() != start;
      if (blocked || walk.at_end()) break;
    }
    check_size();
  }

  void check_size() const {
    if (evidence_.block_count() <= kMaxBlocks) return;
    throw ResolutionError("the map is too large for voxels of {} m; choose larger ones",
                          options_.resolution_m);
  }

  std::vector<Eigen::Vector3f> points_;
  SpaceOptions options_;
  VoxelBlocks<VoxelEvidence> evidence_;
  std::uint32_t view_ = 0;
};

}  // namespace

ObservedSpace observe_space(std::span<const Eigen::Vector3f> p_world,
                            std::span<const Eigen::Isometry3d> T_world_camera,
                            const CameraModel& camera,
                            const SpaceOptions& options) {
  STILLMAP_CHECK(options.resolution_m > 0 && options.max_range_m > 0);
  for (const Eigen::Vector3f& p : p_world) check_reach(p.cast<double>(), options.resolution_m);
  SpaceObserver observer(thinned(p_world, options.resolution_m / 2), options);
  for (const Eigen::Isometry3d& pose : T_world_camera) observer.add_view(pose, camera);
  return observer.take();
}

}  // namespace stillmap
