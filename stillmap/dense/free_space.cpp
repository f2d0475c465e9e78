// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/dense/point_groups.hpp"
#include "stillmap/geometry/lens.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kBatch = 256;
constexpr float kNearest = 0.05F;

/// Of the rays through the corners of the image and the middles of its sides.
double greatest_slope_squared(const CameraModel& camera) {
  double greatest = 0;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d raw((camera.width_px - 1) * x, (camera.height_px - 1) * y);
      const Eigen::Vector2d ideal = camera.undistort(raw);
      // Beyond a fold there are no rays. A fish-eye that sees all in front of it has no bound.
      if (camera.lens != LensModel::kFisheye && !camera.has_ray(ideal)) continue;
      greatest = std::max(greatest, camera.unproject(ideal, 1.0).head<2>().squaredNorm());
    }
  }
  return greatest;
}

/// Consecutive points, which are mostly near each other.
struct Batch {
  std::array<float, kBatch> x{}, y{}, z{};
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0;  // of the ball around the centre that contains them all
};

Batch make_batch(std::span<const Eigen::Vector3f> points) {
  Batch batch;
  Eigen::AlignedBox3f box;
  for (std::size_t n = 0; n < points.size(); ++n) {
    batch.x[n] = points[n].x();
    batch.y[n] = points[n].y();
    batch.z[n] = points[n].z();
    box.extend(points[n]);
  }
  batch.center = box.center();
  batch.radius = 0.5F * box.diagonal().norm() * 1.001F;
  return batch;
}

/// The raw pixels and depths of a batch of points in a camera.
struct Projected {
  std::array<float, kBatch> u, v, z;
};

class Projector {
 public:
  Projector(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world)
      : T_(T_camera_world.matrix().topRows<3>().cast<float>()),
        fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)),
        cx_(static_cast<float>(camera.cx + 0.5)),  // makes truncation round
        cy_(static_cast<float>(camera.cy + 0.5)),
        lens_(lens_of(camera)),
        max_r2_(static_cast<float>(1.1 * greatest_slope_squared(camera))) {}

  /// Whether certainly none of the points is in the image.
  [[nodiscard]] bool misses(const Batch& batch) const {
    const Eigen::Vector3f p = T_.leftCols<3>() * batch.center + T_.col(3);
    // The distance of the centre from the cone around the optical axis that contains the image.
    const float outside = p.head<2>().norm() - std::sqrt(max_r2_) * p.z();
    return outside > batch.radius * std::sqrt(1.0F + max_r2_) || p.z() < kNearest - batch.radius;
  }

  void project(const Batch& batch, Projected& out) const {
    std::visit([&](const auto& lens) { project_with(lens, batch, out); }, lens_);
  }

 private:
  using Lens = std::variant<BrownConradyLens<float>, FisheyeLens<float>>;

  static Lens lens_of(const CameraModel& camera) {
    if (camera.lens == LensModel::kFisheye) return FisheyeLens<float>(camera);
    return BrownConradyLens<float>(camera);
  }

  template <class SomeLens>
  void project_with(const SomeLens lens, const Batch& batch, Projected& out) const {
    const float a = T_(0, 0), b = T_(0, 1), c = T_(0, 2), d = T_(0, 3);
    const float e = T_(1, 0), f = T_(1, 1), g = T_(1, 2), h = T_(1, 3);
    const float i = T_(2, 0), j = T_(2, 1), k = T_(2, 2), l = T_(2, 3);
    for (std::size_t n = 0; n < kBatch; ++n) {  // branch-free, so that it vectorises
      const float px = batch.x[n], py = batch.y[n], pz = batch.z[n];
      const float z = i * px + j * py + k * pz + l;
      const float inverse_z = 1.0F / std::max(z, kNearest);
      const float x = (a * px + b * py + c * pz + d) * inverse_z;
      const float y = (e * px + f * py + g * pz + h) * inverse_z;
      const float r2 = x * x + y * y;
      const LensPoint<float> at = lens(x, y);
      // Far outside the image the distortion polynomial is meaningless and may lead back into the
      // image.
      const float far = r2 < max_r2_ ? 0.0F : -1e6F;
      out.u[n] = fx_ * at.x + cx_ + far;
      out.v[n] = fy_ * at.y + cy_;
      out.z[n] = z;
    }
  }

  Eigen::Matrix<float, 3, 4> T_;
  float fx_, fy_, cx_, cy_;
  Lens lens_;
  float max_r2_;
};

void count_up(std::uint8_t& count) {
  count = static_cast<std::uint8_t>(count + (count < 255 ? 1 : 0));
}

void add_seen(Sightings& s) {
  count_up(s.seen);
  count_up(s.seen_last);
  s.through_last = 0;
}

void add_through(Sightings& s) {
  count_up(s.through);
  count_up(s.through_last);
  s.seen_last = 0;
}

/// Compares points with the range image of one view.
class RangeCheck {
 public:
  RangeCheck(const RangeImage& range, const CameraModel& camera, const FreeSpaceConfig& config)
      : range_(range),
        scale_(1.0F / static_cast<float>(range.block_px)),
        width_(static_cast<float>(camera.width_px)),
        height_(static_cast<float>(camera.height_px)),
        margin_(static_cast<float>(config.margin_m)),
        growth_(static_cast<float>(config.margin_per_m)),
        beside_px_(static_cast<float>(config.beside_share * camera.width_px)),
        beside_m_(static_cast<float>(config.beside_m)) {
    STILLMAP_CHECK(range.columns * range.block_px >= camera.width_px);
    STILLMAP_CHECK(range.rows * range.block_px >= camera.height_px);
  }

  void update(const Projected& at, std::span<Sightings> sightings) const {
    for (std::size_t n = 0; n < sightings.size(); ++n) {
      const float z = at.z[n];
      const RangeCell cell = cell_at(at.u[n], at.v[n]);
      if (!(cell.known() && z > kNearest)) continue;
      const bool here = is_here(cell, z);
      if (cell.moving()) {
        if (here) count_up(sightings[n].moving);
      } else if (here) {
        add_seen(sightings[n]);
      } else if (cell.range_m() > z) {
        add_through(sightings[n]);
      }
    }
  }

  /// Counts `Sightings::beside`.
  void look_beside(const Projected& at, std::span<Sightings> sightings) const {
    for (std::size_t n = 0; n < sightings.size(); ++n) {
      const float z = at.z[n];
      const RangeCell cell = cell_at(at.u[n], at.v[n]);
      if (!(cell.known() && z > kNearest) || !is_here(cell, z)) continue;
      if (moves_beside(at.u[n], at.v[n], z)) count_up(sightings[n].beside);
    }
  }

 private:
  /// The cell of a raw pixel; unknown outside the image.
  [[nodiscard]] RangeCell cell_at(float u, float v) const {
    if (!(u >= 0 && v >= 0 && u < width_ && v < height_)) return {};
    // Just inside the border the product may round up to the border.
    return range_.at(std::min(static_cast<int>(v * scale_), range_.rows - 1),
                     std::min(static_cast<int>(u * scale_), range_.columns - 1));
  }

  [[nodiscard]] bool is_here(RangeCell cell, float z) const {
    return std::abs(cell.range_m() - z) <= margin_ + growth_ * z * z;
  }

  /// Looks in eight directions at three distances. Moving objects are larger than the gaps.
  [[nodiscard]] bool moves_beside(float u, float v, float z) const {
    for (const float share : {0.25F, 0.5F, 1.0F}) {
      const float straight = share * beside_px_, slanting = straight * 0.7F;
      for (const auto& [du, dv] : {std::pair(straight, 0.0F),
                                   {-straight, 0.0F},
                                   {0.0F, straight},
                                   {0.0F, -straight},
                                   {slanting, slanting},
                                   {slanting, -slanting},
                                   {-slanting, slanting},
                                   {-slanting, -slanting}}) {
        const RangeCell cell = cell_at(u + du, v + dv);
        if (cell.moving() && std::abs(cell.range_m() - z) <= beside_m_) return true;
      }
    }
    return false;
  }

  const RangeImage& range_;
  float scale_, width_, height_, margin_, growth_, beside_px_, beside_m_;
};

struct View {
  Projector projector;
  RangeCheck range;
};

std::vector<View> views_of(std::span<const PosedRange> ranges,
                           const CameraModel& camera,
                           const FreeSpaceConfig& config) {
  std::vector<View> views;
  for (const PosedRange& posed : ranges) {
    STILLMAP_CHECK(posed.range != nullptr);
    views.push_back({Projector(camera, posed.T_world_camera.inverse()),
                     RangeCheck(*posed.range, camera, config)});
  }
  return views;
}

/// Calls `check(range check, projected points, their sightings)` for each view and batch. Threads
/// take batches in turn.
template <class Check>
void for_each_batch(std::span<const Eigen::Vector3f> points,
                    std::span<Sightings> all,
                    const std::vector<View>& views,
                    std::size_t threads,
                    const Check& check) {
  in_parallel(threads, [&](std::size_t thread) {
    Projected projected{};
    for (std::size_t begin = thread * kBatch; begin < points.size(); begin += threads * kBatch) {
      const std::size_t size = std::min(kBatch, points.size() - begin);
      const Batch batch = make_batch(points.subspan(begin, size));
      for (const View& view : views) {
        if (view.projector.misses(batch)) continue;
        view.projector.project(batch, projected);
        check(view.range, projected, all.subspan(begin, size));
      }
    }
  });
}

}  // namespace

std::vector<Sightings> sightings(std::span<const Eigen::Vector3f> points,
                                 std::span<const PosedRange> ranges,
                                 const CameraModel& camera,
                                 const FreeSpaceConfig& config,
                                 std::size_t threads) {
  STILLMAP_CHECK(threads > 0);
  const std::vector<View> views = views_of(ranges, camera, config);
  std::vector<Sightings> all(points.size());
  for_each_batch(points,
                 all,
                 views,
                 threads,
                 [](const RangeCheck& range, const Projected& at, std::span<Sightings> some) {
                   range.update(at, some);
                 });
  // Only the weakly seen points, which are few, need the slower search around them.
  std::vector<std::size_t> weak;
  std::vector<Eigen::Vector3f> weak_points;
  std::vector<Sightings> weak_sightings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (all[i].seen > config.weakly_seen) continue;
    weak.push_back(i);
    weak_points.push_back(points[i]);
    weak_sightings.push_back(all[i]);
  }
  for_each_batch(weak_points,
                 weak_sightings,
                 views,
                 threads,
                 [](const RangeCheck& range, const Projected& at, std::span<Sightings> some) {
                   range.look_beside(at, some);
                 });
  for (std::size_t k = 0; k < weak.size(); ++k) all[weak[k]] = weak_sightings[k];
  return all;
}

bool stays(const Sightings& s, const FreeSpaceConfig& config) {
  if (s.moving > config.max_moving_share * s.seen) return false;
  if (s.seen <= config.weakly_seen && s.beside > 0) return false;
  if (s.through == 0) return true;
  if (s.seen_last >= config.min_stay) return true;
  const bool seldom = s.through <= config.max_through_share * s.seen;
  return seldom && s.through_last < config.min_through;
}

PointCloud without_moved(const PointCloud& map,
                         std::span<const PosedRange> ranges,
                         const CameraModel& camera,
                         const FreeSpaceConfig& config,
                         std::size_t threads) {
  const PointGroups groups = group_points(map.positions, config.cell_m);
  const std::vector<Sightings> seen = sightings(groups.means, ranges, camera, config, threads);
  PointCloud kept;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!stays(seen[groups.group_of[i]], config)) continue;
    kept.positions.push_back(map.positions[i]);
    kept.colors.push_back(map.colors[i]);
    if (!map.labels.empty()) kept.labels.push_back(map.labels[i]);
    if (!map.normals.empty()) kept.normals.push_back(map.normals[i]);
  }
  return kept;
}

}  // namespace stillmap
