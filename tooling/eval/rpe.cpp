// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/rpe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

// The pose nearest in time, by bisection. Of two equally near poses it is the one that bisection
// meets first. Rounded stamps make such ties frequent, and the benchmark's figures depend on them.
std::size_t nearest_index(const Trajectory& trajectory, double seconds) {
  std::size_t begin = 0, end = trajectory.size();
  std::size_t best = 0;
  double best_distance = std::abs(trajectory.front().stamp.seconds - seconds);
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    const double offset = trajectory[middle].stamp.seconds - seconds;
    if (std::abs(offset) < best_distance) {
      best_distance = std::abs(offset);
      best = middle;
    }
    if (offset > 0) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return best;
}

double median_interval_s(const Trajectory& trajectory) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    intervals.push_back(trajectory[i].stamp.seconds - trajectory[i - 1].stamp.seconds);
  }
  return statistics(intervals).median;
}

double script_angle_deg(const Eigen::Matrix3d& rotation) {
  const double cosine = std::clamp((rotation.trace() - 1.0) / 2.0, -1.0, 1.0);
  return std::acos(cosine) * 180.0 / std::numbers::pi;
}

// The ground-truth pose near in time, if any.
class NearGroundtruth {
 public:
  explicit NearGroundtruth(const Trajectory& trajectory)
      : trajectory_(trajectory), max_difference_s_(2.0 * median_interval_s(trajectory)) {}

  [[nodiscard]] std::optional<Eigen::Isometry3d> pose(double seconds) const {
    const StampedPose& nearest = trajectory_[nearest_index(trajectory_, seconds)];
    if (std::abs(nearest.stamp.seconds - seconds) > max_difference_s_) return std::nullopt;
    return nearest.T_world_camera;
  }

  /// The time from the nearest pose, where pose() gives one.
  [[nodiscard]] std::optional<double> distance_s(double seconds) const {
    const double distance_s =
        std::abs(trajectory_[nearest_index(trajectory_, seconds)].stamp.seconds - seconds);
    return distance_s > max_difference_s_ ? std::nullopt : std::optional(distance_s);
  }

  /// The pose between those before and after; none where these are far apart.
  [[nodiscard]] std::optional<Eigen::Isometry3d> between(double seconds) const {
    const auto stamp = [](const StampedPose& pose) { return pose.stamp.seconds; };
    const auto after = std::ranges::lower_bound(trajectory_, seconds, {}, stamp);
    if (after == trajectory_.end()) return std::nullopt;
    if (stamp(*after) == seconds) return after->T_world_camera;
    if (after == trajectory_.begin()) return std::nullopt;
    const StampedPose& before = *std::prev(after);
    const double gap_s = stamp(*after) - stamp(before);
    if (gap_s > max_difference_s_) return std::nullopt;
    return interpolate(
        before.T_world_camera, after->T_world_camera, (seconds - stamp(before)) / gap_s);
  }

 private:
  const Trajectory& trajectory_;
  double max_difference_s_;
};

}  // namespace

std::optional<RpeResult> relative_pose_error(const Trajectory& groundtruth,
                                             const Trajectory& estimate,
                                             double delta_s) {
  STILLMAP_CHECK(delta_s > 0.0);
  if (groundtruth.size() < 2) return std::nullopt;
  const NearGroundtruth truth(groundtruth);
  std::vector<double> errors_m, errors_deg;
  for (const StampedPose& from : estimate) {
    const std::size_t j = nearest_index(estimate, from.stamp.seconds + delta_s);
    if (j + 1 == estimate.size()) continue;  // the last pose may be less than delta_s later
    const StampedPose& to = estimate[j];
    const std::optional<Eigen::Isometry3d> truth_from = truth.pose(from.stamp.seconds);
    const std::optional<Eigen::Isometry3d> truth_to = truth.pose(to.stamp.seconds);
    if (!truth_from || !truth_to) continue;
    const Eigen::Isometry3d error =
        (from.T_world_camera.inverse() * to.T_world_camera) * (truth_to->inverse() * *truth_from);
    errors_m.push_back(error.translation().norm());
    errors_deg.push_back(script_angle_deg(error.linear()));
  }
  if (errors_m.size() < 2) return std::nullopt;
  return RpeResult{delta_s, errors_m.size(), statistics(errors_m), statistics(errors_deg)};
}

std::optional<RpeResult> interpolated_relative_pose_error(const Trajectory& groundtruth,
                                                          const Trajectory& estimate,
                                                          double delta_s) {
  if (groundtruth.size() < 2) return std::nullopt;
  const NearGroundtruth truth(groundtruth);
  Trajectory truth_there, estimate_there;
  for (const StampedPose& pose : estimate) {
    const std::optional<Eigen::Isometry3d> T = truth.between(pose.stamp.seconds);
    if (!T) continue;
    truth_there.push_back({pose.stamp, *T});
    estimate_there.push_back(pose);
  }
  return relative_pose_error(truth_there, estimate_there, delta_s);
}

double groundtruth_distance_s(const Trajectory& groundtruth, const Trajectory& estimate) {
  if (groundtruth.size() < 2) return 0;
  const NearGroundtruth truth(groundtruth);
  std::vector<double> distances_s;
  for (const StampedPose& pose : estimate) {
    const std::optional<double> distance_s = truth.distance_s(pose.stamp.seconds);
    if (distance_s) distances_s.push_back(*distance_s);
  }
  if (distances_s.empty()) return 0;
  const std::size_t rank = (distances_s.size() - 1) * 95 / 100;
  std::ranges::nth_element(distances_s, distances_s.begin() + static_cast<std::ptrdiff_t>(rank));
  return distances_s[rank];
}

}  // namespace stillmap
