// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/roles.hpp"

#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) {
  return degrees * kPi / 180.0;
}

FloorPose floor_pose(const Isometry3d& T) {
  return {T.translation().head<2>(), std::atan2(T(1, 0), T(0, 0))};
}

// A pose on a chair, `shift` off its middle, turned to the left against it.
FloorPose seat_on(const World& office,
                  const std::string& chair,
                  const Eigen::Vector2d& shift,
                  double turn) {
  FloorPose seat = floor_pose(thing_named(office, chair).T_world_thing);
  seat.position = seat.place(shift.x(), shift.y());
  seat.yaw += turn;
  return seat;
}

// The transform from a seat to the place of the feet, while seated and after getting up.
constexpr double kSeatToFeet_m = 0.40;

// --- the chair that is pushed -------------------------------------------------------------------

constexpr double kLetsGo_s = 5.0;

ThingMotion pushed_chair(const Isometry3d& T_world_first) {
  const FloorPose first = floor_pose(T_world_first);
  const FloorPath path({{1.0, first.position.x(), first.position.y(), first.yaw},
                        {1.8, 0.72, -1.52, radians(92)},
                        {2.6, 0.62, -0.54, radians(92)},
                        {3.4, 0.61, 0.42, radians(90)},
                        {4.2, 0.59, 1.42, radians(92)},
                        {kLetsGo_s, 0.55, 1.95, radians(94), true}});
  return [=](double t_s) { return t_s <= 1.0 ? T_world_first : path.at(t_s).T_world(0.0); };
}

FloorPath pusher_path(const ThingMotion& chair) {
  const FloorPose first = floor_pose(chair(0.0));
  // Behind the chair; at first beside its middle, as the cabinet leaves no room.
  const Eigen::Vector2d start = first.place(-0.53, 0.20);
  const auto behind = [&](double t_s, double ahead) {
    const FloorPose at = floor_pose(chair(t_s));
    const Eigen::Vector2d p = at.place(ahead, 0.0);
    return PathKey{t_s, p.x(), p.y(), at.yaw};
  };
  PathKey end = behind(kLetsGo_s, -0.60);
  end.stops = true;
  const double north = radians(90);
  return FloorPath({{1.0, start.x(), start.y(), radians(72)},
                    behind(1.8, -0.60),
                    behind(2.6, -0.62),
                    behind(3.4, -0.62),
                    behind(4.2, -0.62),
                    end,
                    {5.15, end.x, end.y, *end.yaw, true},
                    {5.7, 0.28, 1.40, north + radians(60)},
                    {6.6, 0.26, 1.38, north + radians(165), true},
                    {7.0, 0.26, 1.38, north + radians(170), true},
                    {7.6, 0.44, 0.98},
                    {8.3, 0.60, 0.10},
                    {9.0, 0.64, -0.75},
                    {9.6, 0.72, -1.45},
                    {10.3, 0.75, -1.85, north + radians(180), true},
                    {11.0, 0.75, -1.85, north + radians(180), true},
                    {12.0, 0.70, -1.80, north + radians(340), true},
                    {12.7, 0.62, -1.30},
                    {13.4, 0.60, -0.45},
                    {14.1, 0.60, 0.40},
                    {14.8, 0.48, 1.05},
                    {15.5, 0.36, 1.36, north + radians(360), true},
                    {17.0, 0.26, 1.38, north + radians(530), true},
                    {17.6, 0.44, 0.98},
                    {18.3, 0.60, 0.10},
                    {19.0, 0.64, -0.75},
                    {19.6, 0.72, -1.45},
                    {20.3, 0.75, -1.85, north + radians(540), true}});
}

Role pusher(const World& office) {
  const ThingMotion chair = pushed_chair(thing_named(office, "chair_3").T_world_thing);
  Role role{.path = pusher_path(chair),
            .walks = {{1.0, kLetsGo_s},
                      {5.15, 6.6},
                      {7.0, 10.3},
                      {11.0, 12.0},
                      {12.0, 15.5},
                      {15.5, 17.0},
                      {17.0, 20.3}}};
  role.lean = EasedTrack({{0.0, 0.16}, {1.0, 0.16}, {2.0, 0.26}, {4.2, 0.24}, {5.5, 0.0}});
  role.head_yaw = EasedTrack(
      {{2.0, 0.0}, {2.8, 0.5}, {3.6, 0.4}, {4.2, 0.0}, {7.0, 0.0}, {7.6, 0.6}, {8.4, 0.0}});
  Grip grip{.T_world_thing = chair,
            .palms_thing = {Vector3d(-0.235, 0.15, 0.925), Vector3d(-0.235, -0.15, 0.925)},
            .roll = 0.5 * kPi,
            .holds = EasedTrack({{kLetsGo_s + 0.05, 1.0}, {kLetsGo_s + 0.75, 0.0}})};
  role.grips = {grip};
  role.liveliness = 0.4;
  role.loop = Role::Loop{10.8, 20.8};
  return role;
}

// --- the box that is carried --------------------------------------------------------------------

constexpr double kTakes_s = 0.25;
constexpr double kTaken_s = 1.15;
constexpr double kPuts_s = 7.4;
constexpr double kPut_s = 8.2;

FloorPath carrier_path() {
  return FloorPath({{1.7, 1.20, -2.28, radians(-90)},
                    {2.4, 1.14, -2.02, radians(-170)},
                    {3.0, 0.84, -1.55},
                    {3.6, 0.65, -0.85},
                    {4.35, 0.64, 0.00},
                    {5.0, 0.64, 0.52},
                    {5.7, 0.64, 1.00},
                    {6.0, 0.75, 1.27},
                    {6.3, 0.98, 1.54},
                    {6.75, 1.28, 1.98},
                    {7.2, 1.75, 2.26},
                    {7.8, 2.08, 2.30, radians(-360), true},
                    {8.8, 2.08, 2.30, radians(-360), true},
                    {10.0, 1.50, 2.12, radians(-540), true},
                    {10.6, 1.50, 2.12, radians(-540), true},
                    {12.0, 1.48, 2.12, radians(-720), true},
                    {13.2, 2.00, 2.25, radians(-720), true},
                    {14.8, 2.00, 2.25, radians(-900), true},
                    {16.2, 1.50, 2.12, radians(-900), true}});
}

ThingMotion carried_box(const Isometry3d& T_world_first) {
  const FloorPath path = carrier_path();
  const FloorPose first = floor_pose(T_world_first);
  const double first_z = T_world_first.translation().z();
  // The box's x axis is its carrier's left.
  const auto held = [=](double t_s) {
    const FloorPose root = path.at(t_s);
    return FloorPose{root.place(0.37, 0.0), root.yaw + 0.5 * kPi};
  };
  const FloorPose last{{2.55, 2.30}, radians(-270)};
  constexpr double kHeld_z = 0.93;
  constexpr double kLast_z = 0.60;
  const auto blended = [](const FloorPose& a,
                          double a_z,
                          const FloorPose& b,
                          double b_z,
                          double u) {
    const FloorPose pose{a.position + u * (b.position - a.position), a.yaw + u * (b.yaw - a.yaw)};
    return pose.T_world(a_z + u * (b_z - a_z));
  };
  return [=](double t_s) -> Isometry3d {
    if (t_s <= kTakes_s) return T_world_first;
    if (t_s >= kPut_s) return last.T_world(kLast_z);
    if (t_s < kPuts_s) {
      const double taken = ease((t_s - kTakes_s) / (kTaken_s - kTakes_s));
      return blended(first, first_z, held(t_s), kHeld_z, taken);
    }
    const double put = ease((t_s - kPuts_s) / (kPut_s - kPuts_s));
    return blended(held(t_s), kHeld_z, last, kLast_z, put);
  };
}

Role carrier(const World& office) {
  const ThingMotion box = carried_box(thing_named(office, "box_1").T_world_thing);
  Role role{
      .path = carrier_path(),
      .walks = {{1.7, 7.8}, {8.8, 10.0}, {10.6, 12.0}, {12.0, 13.2}, {13.2, 14.8}, {14.8, 16.2}}};
  role.lean =
      EasedTrack({{0.25, 0.55}, {1.2, 0.0}, {7.25, 0.0}, {8.15, 0.95}, {8.25, 0.95}, {9.05, 0.0}});
  role.crouch_m = EasedTrack({{7.35, 0.0}, {8.15, 0.10}, {8.25, 0.10}, {8.95, 0.0}});
  role.head_yaw = EasedTrack({{3.2, 0.0},
                              {3.9, 0.45},
                              {4.9, 0.2},
                              {5.6, 0.0},
                              {16.4, 0.0},
                              {17.4, 0.7},
                              {18.4, 0.7},
                              {19.6, 0.0}});
  Grip grip{.T_world_thing = box,
            .palms_thing = {Vector3d(0.215, 0.0, 0.13), Vector3d(-0.215, 0.0, 0.13)},
            .roll = 0.0,
            .holds = EasedTrack({{kPut_s + 0.05, 1.0}, {kPut_s + 0.75, 0.0}})};
  role.grips = {grip};
  role.liveliness = 0.7;
  role.loop = Role::Loop{10.4, 20.4};
  return role;
}

// --- who gets up from chair_1 and comes back ----------------------------------------------------

Role stroller(const World& office) {
  const FloorPose seat = seat_on(office, "chair_1", {-0.09, -0.05}, radians(-97));
  const Eigen::Vector2d feet = seat.place(kSeatToFeet_m, 0.0);
  const double at_seat = seat.yaw;
  FloorPath path({{1.45, feet.x(), feet.y(), at_seat},
                  {2.1, 0.92, 0.25, radians(-110)},
                  {2.6, 1.00, 0.02, radians(-110)},
                  {3.0, 1.09, -0.05, radians(-125), true},
                  {4.55, 1.10, -0.05, radians(-190), true},
                  {5.15, 0.92, -0.02, radians(-195)},
                  {5.75, 0.69, 0.06, radians(-190), true},
                  {6.9, 0.66, 0.10, radians(-175), true},
                  {7.6, 0.95, 0.38, radians(-130)},
                  {8.2, feet.x(), feet.y(), at_seat, true}});
  Role role{.path = path, .walks = {{1.45, 3.0}, {3.0, 4.55}, {4.55, 5.75}, {6.9, 8.2}}};
  role.seat = Seat{.pose = seat,
                   .seated = EasedTrack({{0.55, 1.0}, {1.6, 0.0}, {8.15, 0.0}, {9.3, 1.0}}),
                   .hands_height_m = {0.09, 0.09}};
  role.head_yaw = EasedTrack({{0.0, -0.6},
                              {0.7, -0.5},
                              {1.6, 0.0},
                              {3.0, 0.0},
                              {4.2, 0.3},
                              {5.0, 0.0},
                              {5.9, -0.4},
                              {6.7, 0.4},
                              {7.5, 0.0},
                              {8.2, 0.0},
                              {9.6, -0.6}});
  role.head_pitch = EasedTrack({{0.0, 0.1}, {1.6, 0.0}, {9.0, 0.0}, {9.8, 0.1}});
  role.liveliness = 0.1;
  role.loop = Role::Loop{0.0, 10.0};
  return role;
}

// A person who stays seated and talks.
Role talker(const FloorPose& seat, const std::array<double, 2>& hands_height_m, double liveliness) {
  const Eigen::Vector2d feet = seat.place(kSeatToFeet_m, 0.0);
  Role role{.path = FloorPath({{0.0, feet.x(), feet.y(), seat.yaw}})};
  role.seat =
      Seat{.pose = seat, .seated = EasedTrack({{0.0, 1.0}}), .hands_height_m = hands_height_m};
  role.talks = EasedTrack({{0.0, 1.0}});
  role.liveliness = liveliness;
  return role;
}

}  // namespace

const Thing& thing_named(const World& world, const std::string& name) {
  for (const Thing& thing : world.things) {
    if (thing.name == name) return thing;
  }
  throw Error("the office has no thing named '{}'; use one of make_office()", name);
}

Play sitting_play(const World& office) {
  Play play;
  play.roles.push_back(
      talker(seat_on(office, "chair_1", {0.05, 0.0}, radians(-60)), {0.21, 0.09}, 0.1));
  play.roles.back().head_yaw = EasedTrack({{0.0, -0.35}});
  play.roles.push_back(talker(seat_on(office, "chair_2", {-0.04, -0.07}, 0.0), {0.21, 0.21}, 0.55));
  play.roles.back().head_yaw = EasedTrack({{0.0, -0.30}});
  return play;
}

Play walking_play(const World& office) {
  Play play;
  play.roles = {stroller(office), pusher(office), carrier(office)};
  for (std::size_t i = 1; i < play.roles.size(); ++i) {
    play.things.push_back(
        {i == 1 ? "chair_3" : "box_1", play.roles[i].grips.front().T_world_thing});
  }
  return play;
}

}  // namespace stillmap
