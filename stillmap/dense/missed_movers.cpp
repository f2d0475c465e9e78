// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/missed_movers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>

namespace stillmap {
namespace {

constexpr std::size_t kFrames = 90;         // remembered; views are made within 30 frames
constexpr std::size_t kLeastSightings = 3;  // of a mover
constexpr double kVelocityOver_s = 0.35;    // enough for the noise of the middle
constexpr double kLeastOver_s = 0.1;
constexpr double kFastest_m_s = 2.0;
constexpr double kCell_m = 0.05;

/// Cells of space within a distance of some points.
class NearCells {
 public:
  NearCells(std::span<const Eigen::Vector3d> points, double reach_m) {
    for (const Eigen::Vector3d& p : points) box_.extend(p);
    box_.min().array() -= reach_m;
    box_.max().array() += reach_m;
    size_ = ((box_.sizes() / kCell_m).array().floor().cast<int>() + 1).matrix();
    near_.assign(static_cast<std::size_t>(size_.prod()), false);
    for (const Eigen::Vector3d& p : points) mark(p, reach_m);
  }

  [[nodiscard]] bool covers(const Eigen::Vector3d& p) const {
    return box_.contains(p) && near_[index(cell_of(p))];
  }

 private:
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& p) const {
    return ((p - box_.min()) / kCell_m).array().floor().cast<int>();
  }
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& cell) const {
    return static_cast<std::size_t>((cell.z() * size_.y() + cell.y()) * size_.x() + cell.x());
  }
  void mark(const Eigen::Vector3d& p, double reach_m) {
    const Eigen::Vector3i middle = cell_of(p);
    const int reach = static_cast<int>(std::ceil(reach_m / kCell_m));
    const Eigen::Vector3i low = (middle.array() - reach).max(0);
    const Eigen::Vector3i high = (middle.array() + reach).min(size_.array() - 1);
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          const Eigen::Vector3i cell(x, y, z);
          const double distance_m = (cell - middle).cast<double>().norm() * kCell_m;
          if (distance_m <= reach_m) near_[index(cell)] = true;
        }
      }
    }
  }

  Eigen::AlignedBox3d box_;
  Eigen::Vector3i size_;
  std::vector<bool> near_;
};

}  // namespace

void MissedMovers::remember(double stamp_s, std::vector<MoverSighting> movers) {
  frames_.push_back({stamp_s, std::move(movers)});
  if (frames_.size() > kFrames) frames_.pop_front();
}

// The velocity at each place is that to the place some tenths of a second earlier, or later at the
// beginning.
std::vector<MissedMovers::Place> MissedMovers::track_of(TrackId track) const {
  std::vector<Place> places;
  std::vector<Eigen::Vector3d> middles;
  for (const Frame& frame : frames_) {
    const MoverSighting* largest = nullptr;
    for (const MoverSighting& mover : frame.movers) {
      if (mover.track != track || mover.surface.empty()) continue;
      if (largest == nullptr || mover.surface.size() > largest->surface.size()) largest = &mover;
    }
    if (largest == nullptr) continue;
    places.push_back({frame.stamp_s, &largest->surface, Eigen::Vector3d::Zero()});
    middles.push_back(median_point(largest->surface));
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t other = i;
    while (other > 0 && places[i].stamp_s - places[other - 1].stamp_s <= kVelocityOver_s) --other;
    if (other == i) {
      while (other + 1 < places.size() &&
             places[other + 1].stamp_s - places[i].stamp_s <= kVelocityOver_s) {
        ++other;
      }
    }
    const double elapsed_s = places[i].stamp_s - places[other].stamp_s;
    if (std::abs(elapsed_s) < kLeastOver_s) continue;
    Eigen::Vector3d velocity = (middles[i] - middles[other]) / elapsed_s;
    velocity *= std::min(1.0, kFastest_m_s / std::max(velocity.norm(), 1e-9));
    places[i].velocity_m_s = velocity;
  }
  return places;
}

std::vector<Eigen::Vector3d> MissedMovers::places_at(double stamp_s) const {
  std::set<TrackId> absent, present;
  for (const Frame& frame : frames_) {
    if (std::abs(frame.stamp_s - stamp_s) > config_.within_s) continue;
    for (const MoverSighting& mover : frame.movers) {
      (frame.stamp_s == stamp_s ? present : absent).insert(mover.track);
    }
  }
  std::vector<Eigen::Vector3d> points;
  for (const TrackId track : absent) {
    if (present.contains(track)) continue;
    const std::vector<Place> places = track_of(track);
    if (places.size() < kLeastSightings) continue;
    const auto after = std::ranges::find_if(
        places, [stamp_s](const Place& place) { return place.stamp_s > stamp_s; });
    std::vector<Place> nearest;
    if (after != places.end()) nearest.push_back(*after);
    if (after != places.begin()) nearest.push_back(*std::prev(after));
    for (const Place& place : nearest) {
      const double elapsed_s = stamp_s - place.stamp_s;
      if (std::abs(elapsed_s) > config_.within_s) continue;
      for (const double share : {0.0, 0.5, 1.0}) {
        const Eigen::Vector3d moved = share * elapsed_s * place.velocity_m_s;
        for (const Eigen::Vector3d& p : *place.surface) points.push_back(p + moved);
      }
    }
  }
  return points;
}

StaticView without_places(const StaticView& view,
                          std::span<const Eigen::Vector3d> places,
                          double reach_m) {
  if (places.empty()) return view;
  const NearCells near(places, reach_m);
  StaticView kept = view;
  CompactCloud& cloud = kept.cloud;
  std::size_t size = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (near.covers(cloud.position(i).cast<double>())) continue;
    cloud.places[size] = cloud.places[i];
    cloud.colors[size] = cloud.colors[i];
    if (!cloud.labels.empty()) cloud.labels[size] = cloud.labels[i];
    ++size;
  }
  cloud.places.resize(size);
  cloud.colors.resize(size);
  if (!cloud.labels.empty()) cloud.labels.resize(size);
  return kept;
}

}  // namespace stillmap
