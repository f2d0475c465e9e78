// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/surface_fusion.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/label_vote.hpp"
#include "stillmap/dense/mean_color.hpp"
#include "stillmap/dense/point_batches.hpp"
#include "stillmap/dense/point_groups.hpp"
#include "stillmap/dense/surface_image.hpp"

namespace stillmap {
namespace {

constexpr float kAgree = 0.95F;  // length of the mean of normals that are those of one plane

struct FusionView {
  BatchProjector projector;
  Eigen::Vector3f center;  // of the camera, in the world
  Eigen::Matrix3f R_world_camera;
  SurfaceImage surface;
};

/// What the views say of one point.
struct Evidence {
  float weight = 0;
  Eigen::Vector3f move = Eigen::Vector3f::Zero();    // weighted sum
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // weighted sum
};

class Measurement {
 public:
  Measurement(const CameraModel& camera, const SurfaceFusionConfig& config)
      : fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)),
        sigma_(static_cast<float>(config.sigma_m)),
        growth_(static_cast<float>(config.sigma_per_m)),
        gate_(static_cast<float>(config.gate_m)),
        sigmas_(static_cast<float>(config.gate_sigmas)) {}

  void add(const FusionView& view,
           const ProjectedBatch& at,
           std::span<const Eigen::Vector3f> points,
           std::span<Evidence> evidence) const {
    const SurfaceImage& image = view.surface;
    const auto cell_px = static_cast<float>(image.cell_px);
    const float per_px = 1.0F / cell_px;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const float u = at.u[n], v = at.v[n], z = at.z[n];
      if (!(z > kNearestDepth_m && u >= 0 && v >= 0)) continue;
      const int column = static_cast<int>(u * per_px), row = static_cast<int>(v * per_px);
      if (column >= image.columns || row >= image.rows) continue;
      const SurfaceCell& cell = image.at(row, column);
      if (!cell.known()) continue;
      const float right = u - (static_cast<float>(column) + 0.5F) * cell_px;
      const float down = v - (static_cast<float>(row) + 0.5F) * cell_px;
      const float inverse = cell.inverse_depth + right * cell.per_column + down * cell.per_row;
      if (inverse <= 0) continue;
      const float measured = 1.0F / inverse;
      const float sigma = sigma_ + growth_ * z * z;
      const float off = measured - z;
      if (std::abs(off) > gate_ + sigmas_ * sigma) continue;
      // Half a pixel to the side changes the depth on slanting surface.
      const float square = measured * measured;
      const float slope2 =
          square * square * (cell.per_column * cell.per_column + cell.per_row * cell.per_row);
      const float weight = 1.0F / (sigma * sigma + 0.25F * slope2);
      const Eigen::Vector3f ray = points[n] - view.center;  // to the point
      Evidence& e = evidence[n];
      e.weight += weight;
      e.move += (weight * off / z) * ray;
      e.normal += weight * normal_of(view, cell, ray / z, inverse);
    }
  }

 private:
  /// A plane n p = 1 has the inverse depth n (x, y, 1) at the ray (x, y, 1); its gradient is (nx,
  /// ny).
  [[nodiscard]] Eigen::Vector3f normal_of(const FusionView& view,
                                          const SurfaceCell& cell,
                                          const Eigen::Vector3f& ray_world,
                                          float inverse) const {
    const Eigen::Vector3f ray = view.R_world_camera.transpose() * ray_world;
    const float a = fx_ * cell.per_column, b = fy_ * cell.per_row;
    const Eigen::Vector3f away(a, b, inverse - a * ray.x() - b * ray.y());
    return view.R_world_camera * (-away.normalized());
  }

  float fx_, fy_, sigma_, growth_, gate_, sigmas_;
};

/// Moves points to the surface and tells its normals, zero where no view measures any.
class Fusion {
 public:
  Fusion(std::span<const PosedCloud> clouds,
         const CameraModel& camera,
         int cell_px,
         const SurfaceFusionConfig& config,
         std::size_t threads)
      : measurement_(camera, config), threads_(threads) {
    for (const PosedCloud& posed : clouds) {
      STILLMAP_CHECK(posed.cloud != nullptr);
      views_.push_back({BatchProjector(camera, posed.T_world_camera.inverse()),
                        posed.T_world_camera.translation().cast<float>(),
                        posed.T_world_camera.linear().cast<float>(),
                        surface_image(*posed.cloud, camera, cell_px)});
    }
  }

  /// The displacements of cubes of that edge, from the means of their points.
  [[nodiscard]] CubeMoves moves_of(std::span<const Eigen::Vector3f> means, double cube_m) const {
    CubeMoves moves(cube_m);
    const PointGroups cubes = group_points(means, cube_m);
    const std::vector<Evidence> evidence = ask(cubes.means);
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      const Evidence& e = evidence[i];
      if (e.weight <= 0) continue;
      CubeMoves::Move move{cubes.means[i], e.move / e.weight};
      if (e.normal.norm() > kAgree * e.weight) move.normal = e.normal.normalized();
      moves.add(move);
    }
    return moves;
  }

  /// `cloud` has one point in each voxel.
  [[nodiscard]] PointCloud moved(PointCloud cloud, double voxel_size_m) const {
    const PointGroups voxels = group_points(cloud.positions, voxel_size_m);
    const std::vector<Evidence> evidence = ask(voxels.means);
    cloud.normals.assign(cloud.size(), Eigen::Vector3f::Zero());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Evidence& e = evidence[voxels.group_of[i]];
      if (e.weight <= 0) continue;
      cloud.positions[i] += e.move / e.weight;
      cloud.normals[i] = e.normal.normalized();
    }
    return cloud;
  }

 private:
  /// `points` are grouped, so that those of a batch are near each other.
  [[nodiscard]] std::vector<Evidence> ask(const std::vector<Eigen::Vector3f>& points) const {
    std::vector<Evidence> evidence(points.size());
    for_each_batch(
        points,
        views_,
        threads_,
        [&](const FusionView& view, const ProjectedBatch& at, std::size_t begin, std::size_t size) {
          measurement_.add(view,
                           at,
                           std::span(points).subspan(begin, size),
                           std::span(evidence).subspan(begin, size));
        });
    return evidence;
  }

  std::vector<FusionView> views_;
  Measurement measurement_;
  std::size_t threads_;
};

/// What the points of one voxel have in common.
struct VoxelSum {
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> color{};
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  LabelVote labels;
};

/// The mean point of each voxel, along a space-filling curve.
PointCloud one_per_voxel(const PointCloud& cloud, double voxel_size_m) {
  PointGroups voxels = group_points(cloud.positions, voxel_size_m);
  std::vector<VoxelSum> sums(voxels.means.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    VoxelSum& sum = sums[voxels.group_of[i]];
    ++sum.count;
    for (std::size_t c = 0; c < 3; ++c) sum.color[c] += cloud.colors[i][c];
    if (!cloud.normals.empty()) sum.normal += cloud.normals[i];
    if (!cloud.labels.empty() && sum.count <= LabelVote::kMostVotes)
      sum.labels.add(cloud.labels[i], 1);
  }
  PointCloud thin;
  thin.positions = std::move(voxels.means);
  for (const VoxelSum& sum : sums) {
    thin.colors.push_back(mean_color(sum.color, sum.count));
    if (!cloud.normals.empty()) thin.normals.push_back(sum.normal.normalized());
    if (!cloud.labels.empty()) thin.labels.push_back(sum.labels.winner());
  }
  return thin;
}

}  // namespace

PointCloud fused_surface(std::span<const PosedCloud> clouds,
                         const CameraModel& camera,
                         int cell_px,
                         double voxel_size_m,
                         const SurfaceFusionConfig& config,
                         std::size_t threads) {
  const Fusion fusion(clouds, camera, cell_px, config, threads);
  const double cube_m = config.cube_voxels * voxel_size_m;
  std::vector<CubeMoves> moves;
  for (int round = 1; round < config.rounds; ++round) {
    moves.push_back(
        fusion.moves_of(global_cloud(clouds, cube_m, threads, moves).positions, cube_m));
  }
  PointCloud map = global_cloud(clouds, voxel_size_m, threads, moves);
  return one_per_voxel(fusion.moved(std::move(map), voxel_size_m), voxel_size_m);
}

}  // namespace stillmap
