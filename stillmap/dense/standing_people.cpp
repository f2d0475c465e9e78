// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/standing_people.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

#include "stillmap/perception/objects/object_look.hpp"

namespace stillmap {
namespace {

constexpr double kStep_m = 0.15;    // a person who moves farther does not stand
constexpr double kWalk_m = 0.4;     // a thing that is taken for a person never moves so far
constexpr double kStands_s = 1.0;   // without a step
constexpr double kBehind_m = 0.2;   // distance of surface that shows a point to be free
constexpr double kMostFree = 0.5;   // share of a person's points
constexpr double kLeastSeen = 0.3;  // the same, in the image
constexpr int kCell_px = 8;         // views have a point each 4 pixels

/// The nearest depth of a view in cells of the image; 0 where it shows no static surface.
cv::Mat1f nearest_depths(const CompactCloud& cloud, const CameraModel& camera) {
  cv::Mat1f nearest(camera.height_px / kCell_px + 1, camera.width_px / kCell_px + 1, 0.0F);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.position(i).cast<double>();
    if (p.z() <= 0) continue;
    const Eigen::Vector2d cell = camera.project(p) / kCell_px;
    if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() < nearest.cols && cell.y() < nearest.rows)) {
      continue;
    }
    float& z = nearest(static_cast<int>(cell.y()), static_cast<int>(cell.x()));
    z = z > 0 ? std::min(z, static_cast<float>(p.z())) : static_cast<float>(p.z());
  }
  return nearest;
}

struct Sight {
  std::size_t inside = 0;  // points in the image
  std::size_t free = 0;    // of these, before the view's surface
};

Sight sight_of(const std::vector<Eigen::Vector3d>& points,
               const cv::Mat1f& nearest,
               const CameraModel& camera,
               const Eigen::Isometry3d& T_camera_odometry) {
  Sight sight;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = T_camera_odometry * point;
    if (p.z() <= 0) continue;
    const Eigen::Vector2d px = camera.project(p);
    if (!(px.x() >= 0 && px.y() >= 0 && px.x() < camera.width_px && px.y() < camera.height_px)) {
      continue;
    }
    ++sight.inside;
    const float z =
        nearest(static_cast<int>(px.y()) / kCell_px, static_cast<int>(px.x()) / kCell_px);
    if (z > p.z() + kBehind_m) ++sight.free;
  }
  return sight;
}

}  // namespace

void StandingPeople::remember(double stamp_s, const std::vector<MoverSighting>& movers) {
  if (!movers.empty()) frames_.push_back({stamp_s, movers});
}

void StandingPeople::see(double stamp_s, const MoverSighting& mover) {
  Person& person = people_[mover.track];
  const bool is_new = person.surface.empty();
  person.seen_s = stamp_s;
  person.left = false;
  if (mover.surface.empty()) return;
  const Eigen::Vector3d middle = median_point(mover.surface);
  if (is_new) person.first = middle;
  person.walked = person.walked || (middle - person.first).norm() > kWalk_m;
  if (is_new || (middle - person.place).norm() > kStep_m) {
    person.place = middle;
    person.since_s = stamp_s;
  }
  person.surface = mover.surface;
}

std::vector<Eigen::Vector3d> StandingPeople::unseen_in(const StaticView& view,
                                                       const CameraModel& camera,
                                                       const Eigen::Isometry3d& T_camera_odometry,
                                                       double stamp_s) {
  for (; !frames_.empty() && frames_.front().stamp_s <= stamp_s; frames_.pop_front()) {
    for (const MoverSighting& mover : frames_.front().movers) see(frames_.front().stamp_s, mover);
  }
  std::vector<Eigen::Vector3d> points;
  cv::Mat1f nearest;
  for (auto& [track, person] : people_) {
    const bool stood = person.walked && person.seen_s - person.since_s >= kStands_s;
    if (!stood || person.left || person.seen_s == stamp_s) continue;
    if (nearest.empty()) nearest = nearest_depths(view.cloud, camera);
    const Sight sight = sight_of(person.surface, nearest, camera, T_camera_odometry);
    const auto share = [](std::size_t part, std::size_t of) {
      return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(of, 1));
    };
    if (share(sight.inside, person.surface.size()) < kLeastSeen) continue;
    person.left = share(sight.free, sight.inside) > kMostFree;
    if (!person.left) points.insert(points.end(), person.surface.begin(), person.surface.end());
  }
  return points;
}

}  // namespace stillmap
