// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "simulation/scene/body.hpp"
#include "simulation/scene/gait.hpp"
#include "simulation/scene/track.hpp"

namespace stillmap {

/// The pose of a thing over time.
using ThingMotion = std::function<Eigen::Isometry3d(double t_s)>;

/// Two hands that hold a thing.
struct Grip {
  ThingMotion T_world_thing;
  std::array<Eigen::Vector3d, 2> palms_thing;  ///< positions of the left and the right palm on it
  double roll = 0;                             ///< of the palms, as in PalmGoal
  EasedTrack holds{{{0.0, 0.0}}};              ///< 1 while held, 0 while not
};

/// A seat: the pelvis is on the seat, the feet are on the path.
struct Seat {
  FloorPose pose;
  EasedTrack seated{{{0.0, 0.0}}};                 ///< 1 while seated
  std::array<double, 2> hands_height_m{0.1, 0.1};  ///< of the resting palms over the pelvis joint
};

/// The actions of a person. Times of tracks are those of `loop`.
struct Role {
  FloorPath path;
  std::vector<Walk> walks{};
  std::optional<Seat> seat{};
  EasedTrack lean{{{0.0, 0.0}}};
  EasedTrack crouch_m{{{0.0, 0.0}}};  ///< lowering of the pelvis
  EasedTrack head_yaw{{{0.0, 0.0}}};
  EasedTrack head_pitch{{{0.0, 0.0}}};
  EasedTrack talks{{{0.0, 0.0}}};  ///< 1: gestures and looks about
  std::vector<Grip> grips{};
  double liveliness = 0;  ///< phase of the small movements
  /// From `end_s` on, the time from `start_s` to `end_s` repeats.
  struct Loop {
    double start_s;
    double end_s;
  };
  std::optional<Loop> loop{};
};

/// A person with a role.
class Actor {
 public:
  /// `body` must outlive the actor.
  Actor(const Body& body, Role role);

  [[nodiscard]] BodyPose at(double t_s) const;

 private:
  [[nodiscard]] TrunkPosture trunk(const Stance& stance, double role_s, double t_s) const;
  [[nodiscard]] PalmGoal palm(
      const BodyPose& pose, BodySide side, double swing, double role_s, double t_s) const;

  const Body* body_;
  Role role_;
  double pelvis_height_m_;
  Footfalls feet_;
};

}  // namespace stillmap
