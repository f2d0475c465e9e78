// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "simulation/scene/body.hpp"
#include "simulation/scene/posture.hpp"
#include "simulation/scene/track.hpp"

namespace stillmap {

/// A time interval of walking.
struct Walk {
  double start_s;
  double end_s;
};

/// The feet of a person who follows a path. A foot that bears weight rests where it was put down;
/// it rolls over the heel when it comes down and over the toes when it lifts.
class Footfalls {
 public:
  /// The path rests outside the walks. `half_width_m`: from the path's middle to each ankle.
  Footfalls(const FloorPath& path, const std::vector<Walk>& walks, double half_width_m);

  /// A foot's frame at a time: origin on the sole below the ankle, x to the toes; and its lift by
  /// the step, 0 while it stands.
  struct Foot {
    Eigen::Isometry3d T_world_sole;
    double lift_m;
  };
  [[nodiscard]] Foot at(double t_s, BodySide side) const;

 private:
  struct Step {
    double lifts_s;
    double lands_s;
    FloorPose from;
    FloorPose to;
  };

  void add_walk(const FloorPath& path, const Walk& walk);

  double half_width_m_;
  std::array<FloorPose, 2> first_;
  std::array<std::vector<Step>, 2> steps_;
};

/// The posture of a person who stands or walks: the pelvis as high as the legs allow, arms swinging
/// opposite to the feet.
struct Stance {
  FloorPose root;
  std::array<Footfalls::Foot, 2> feet;
};

/// The pelvis over a stance: it bobs, sways over the foot that bears, and turns with the steps.
[[nodiscard]] Eigen::Isometry3d pelvis_over(const Skeleton& skeleton,
                                            double pelvis_height_m,
                                            const Stance& stance);

/// The distance of the left foot ahead of the right one, metres.
[[nodiscard]] double stride_of(const Stance& stance);

/// The ankle of a foot.
[[nodiscard]] Eigen::Isometry3d ankle_of(const Skeleton& skeleton,
                                         double pelvis_height_m,
                                         const Footfalls::Foot& foot);

}  // namespace stillmap
