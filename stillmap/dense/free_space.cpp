// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/detached_pieces.hpp"
#include "stillmap/dense/point_batches.hpp"
#include "stillmap/dense/point_groups.hpp"
#include "stillmap/dense/selected_points.hpp"

namespace stillmap {
namespace {

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

  void update(const ProjectedBatch& at, std::span<Sightings> sightings) const {
    for (std::size_t n = 0; n < sightings.size(); ++n) {
      const float z = at.z[n];
      const RangeCell cell = cell_at(at.u[n], at.v[n]);
      if (!(cell.known() && z > kNearestDepth_m)) continue;
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
  void look_beside(const ProjectedBatch& at, std::span<Sightings> sightings) const {
    for (std::size_t n = 0; n < sightings.size(); ++n) {
      const float z = at.z[n];
      const RangeCell cell = cell_at(at.u[n], at.v[n]);
      if (!(cell.known() && z > kNearestDepth_m) || !is_here(cell, z)) continue;
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
  BatchProjector projector;
  RangeCheck range;
};

std::vector<View> views_of(std::span<const PosedRange> ranges,
                           const CameraModel& camera,
                           const FreeSpaceConfig& config) {
  std::vector<View> views;
  for (const PosedRange& posed : ranges) {
    STILLMAP_CHECK(posed.range != nullptr);
    views.push_back({BatchProjector(camera, posed.T_world_camera.inverse()),
                     RangeCheck(*posed.range, camera, config)});
  }
  return views;
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
  for_each_batch(
      points,
      views,
      threads,
      [&all](const View& view, const ProjectedBatch& at, std::size_t begin, std::size_t size) {
        view.range.update(at, std::span(all).subspan(begin, size));
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
  for_each_batch(
      weak_points,
      views,
      threads,
      [&](const View& view, const ProjectedBatch& at, std::size_t begin, std::size_t size) {
        view.range.look_beside(at, std::span(weak_sightings).subspan(begin, size));
      });
  for (std::size_t k = 0; k < weak.size(); ++k) all[weak[k]] = weak_sightings[k];
  return all;
}

bool stays(const Sightings& s, const FreeSpaceConfig& config) {
  if (s.moving > config.max_moving_share * s.seen) return false;
  if (s.seen <= config.weakly_seen && s.beside > 0 && s.beside == s.seen) return false;
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
  std::vector<bool> kept(seen.size());
  for (std::size_t k = 0; k < seen.size(); ++k) kept[k] = stays(seen[k], config);
  kept = without_detached_pieces(groups.means, seen, std::move(kept), config);
  return selected_points(map, [&](std::size_t i) { return kept[groups.group_of[i]]; });
}

}  // namespace stillmap
