// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/gait.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep_s = 0.52;
constexpr double kToeOut = 0.10;
constexpr double kLift_m = 0.075;
constexpr double kToeOff = 0.50;      // pitch of a lifting foot, at a full step
constexpr double kHeelStrike = 0.28;  // pitch of a landing foot
constexpr double kToe_m = 0.135;      // pivots, from below the ankle
constexpr double kHeel_m = -0.045;
constexpr double kFullStep_m = 1.1;

double side_sign(std::size_t side) {
  return side == 0 ? 1.0 : -1.0;
}

// From 0 up to 1 and back while x goes from 0 to 1.
double bump(double x) {
  if (x <= 0.0 || x >= 1.0) return 0.0;
  const double s = std::sin(std::numbers::pi * x);
  return s * s;
}

FloorPose foot_beside(const FloorPose& root, std::size_t side, double half_width_m) {
  const double y = side_sign(side);
  return {root.place(-0.02, y * half_width_m), root.yaw + y * kToeOut};
}

// Turns by `pitch` (toes down) about a place on the sole.
Isometry3d pitched_about(double x, double pitch) {
  return Eigen::Translation3d(x, 0, 0) * AngleAxisd(pitch, Vector3d::UnitY()) *
         Eigen::Translation3d(-x, 0, 0);
}

// The least of three, rounded within about `soft`.
double soft_minimum(double a, double b, double c, double soft) {
  const double least = std::min({a, b, c});
  const double sum =
      std::exp((least - a) / soft) + std::exp((least - b) / soft) + std::exp((least - c) / soft);
  return least - soft * std::log(sum);
}

}  // namespace

Footfalls::Footfalls(const FloorPath& path, const std::vector<Walk>& walks, double half_width_m)
    : half_width_m_(half_width_m) {
  const double first_s = walks.empty() ? 0.0 : walks.front().start_s;
  for (std::size_t side = 0; side < 2; ++side) {
    first_[side] = foot_beside(path.at(first_s), side, half_width_m);
  }
  for (const Walk& walk : walks) add_walk(path, walk);
}

void Footfalls::add_walk(const FloorPath& path, const Walk& walk) {
  const int count =
      std::max(2, static_cast<int>(std::lround((walk.end_s - walk.start_s) / kStep_s)));
  const double step_s = (walk.end_s - walk.start_s) / count;
  // The foot on the side that the path turns to goes first.
  const double turn = path.at(walk.start_s + step_s).yaw - path.at(walk.start_s).yaw;
  const std::size_t first_side = turn < 0 ? 1 : 0;
  for (int k = 0; k < count; ++k) {
    const std::size_t side = (first_side + std::size_t(k)) % 2;
    // The middle of the time for which the foot bears weight; the last two end side by side.
    const double middle_s = k + 2 >= count ? walk.end_s : walk.start_s + (k + 1.5) * step_s;
    const FloorPose from = steps_[side].empty() ? first_[side] : steps_[side].back().to;
    steps_[side].push_back({walk.start_s + (k + 0.06) * step_s,
                            walk.start_s + (k + 0.94) * step_s,
                            from,
                            foot_beside(path.at(middle_s), side, half_width_m_)});
  }
}

Footfalls::Foot Footfalls::at(double t_s, BodySide body_side) const {
  const std::size_t side = static_cast<std::size_t>(body_side);
  FloorPose flat = first_[side];
  double lift = 0.0;
  double toe_off = 0.0;
  double heel_strike = 0.0;
  for (const Step& step : steps_[side]) {
    const double lasts = step.lands_s - step.lifts_s;
    const double size = std::min(1.0, (step.to.position - step.from.position).norm() / kFullStep_m);
    // The heel rises before the toes lift, and lands before the toes do.
    toe_off += kToeOff * size * bump((t_s - step.lifts_s + 0.35 * lasts) / (0.90 * lasts));
    heel_strike += kHeelStrike * size * bump((t_s - step.lands_s + 0.50 * lasts) / (0.85 * lasts));
    if (t_s <= step.lifts_s) continue;
    const double u = (t_s - step.lifts_s) / lasts;
    const double share = ease(u);
    lift = (0.45 + 0.55 * size) * kLift_m * bump(u);
    flat.position = (1.0 - share) * step.from.position + share * step.to.position;
    flat.yaw = (1.0 - share) * step.from.yaw + share * step.to.yaw;
  }
  return {
      flat.T_world(lift) * pitched_about(kToe_m, toe_off) * pitched_about(kHeel_m, -heel_strike),
      lift};
}

double stride_of(const Stance& stance) {
  const Vector3d ahead =
      stance.feet[0].T_world_sole.translation() - stance.feet[1].T_world_sole.translation();
  return ahead.head<2>().dot(stance.root.forward());
}

Isometry3d ankle_of(const Skeleton& skeleton, double pelvis_height_m, const Footfalls::Foot& foot) {
  const double ankle_m = pelvis_height_m + rest_place(skeleton, Joint::kLeftAnkle).z();
  return foot.T_world_sole * Eigen::Translation3d(0, 0, ankle_m);
}

Isometry3d pelvis_over(const Skeleton& skeleton, double pelvis_height_m, const Stance& stance) {
  const Vector3d hip = rest_place(skeleton, Joint::kLeftHip);
  const double reach = 0.985 * leg_length(skeleton);
  const double sway = 0.30 * (stance.feet[1].lift_m - stance.feet[0].lift_m);
  const double turn = -0.12 * stride_of(stance);
  FloorPose root = stance.root;
  root.position = root.place(0.0, sway);
  root.yaw += turn;
  std::array<double, 2> highest{};
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3d ankle = ankle_of(skeleton, pelvis_height_m, stance.feet[side]).translation();
    const double away = (root.place(0.0, side_sign(side) * hip.y()) - ankle.head<2>()).norm();
    const double rise = std::sqrt(std::max(reach * reach - away * away, 0.01));
    highest[side] = ankle.z() + rise - hip.z();
  }
  const double z = soft_minimum(pelvis_height_m - 0.004, highest[0], highest[1], 0.006);
  const double roll = 0.9 * (stance.feet[0].lift_m - stance.feet[1].lift_m);
  return root.T_world(z) * AngleAxisd(-0.6 * roll, Vector3d::UnitX());
}

}  // namespace stillmap
