// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "stillmap/perception/objects/frame_objects.hpp"

namespace stillmap {

/// What a class of objects is to a map of what stands still (Fan 2020, section III).
enum class Category : std::uint8_t {
  kStatic,              ///< stays where it is
  kPotentiallyDynamic,  ///< moves when somebody moves it
  kDynamic,             ///< moves by itself
};

[[nodiscard]] std::string_view category_name(Category category);

/// From the nearest to the farthest depth of something, metres.
struct DepthInterval {
  float min_m = 0;
  float max_m = 0;

  [[nodiscard]] bool overlaps(const DepthInterval& other) const {
    return !(max_m < other.min_m || other.max_m < min_m);
  }
  [[nodiscard]] bool contains(float depth_m) const { return depth_m >= min_m && depth_m <= max_m; }
};

/// Why an object is taken as dynamic or static in a frame.
enum class StateReason : std::uint8_t {
  kStaticClass,   ///< static
  kBoxesApart,    ///< static: no person is near it in the image
  kDepthsApart,   ///< static: a person is before or behind it
  kNotAsked,      ///< static: interaction is not judged
  kDynamicClass,  ///< dynamic: it moves by itself
  kTouching,      ///< dynamic: a person is at it
  kDepthUnknown,  ///< dynamic: a person may be at it
  kMoving,        ///< dynamic: it has been seen to move
};
[[nodiscard]] std::string_view reason_name(StateReason reason);

enum class MotionState : std::uint8_t {
  kUnknown,  ///< not seen often enough, or without depth
  kStill,
  kMoving,
  kMovedBySomeone,  ///< moving, and a person is at it
};
[[nodiscard]] std::string_view motion_name(MotionState state);

/// How an object moves, in the world frame of the frame's pose.
struct Motion {
  MotionState state = MotionState::kUnknown;
  /// Middle of the visible surface, metres; none without depth.
  std::optional<Eigen::Vector3d> p_world;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< 0 where unknown
  double velocity_error_m_s = 0;                           ///< standard error of its length
  std::optional<TrackId> by;                               ///< who moves it
};

/// An object as a frame shows it: who it is, whether it is taken as dynamic and why, how it moves.
struct ObjectState {
  TrackId track;
  std::string class_name;  ///< of COCO where that has one
  Category category = Category::kStatic;
  bool dynamic = false;
  StateReason reason = StateReason::kStaticClass;
  std::optional<TrackId> person;  ///< who touches it, or is before or behind it
  PixelBox box;
  bool filled = false;                  ///< the network has missed it in this frame
  std::optional<DepthInterval> depths;  ///< of its mask, outliers removed; metres
  float median_depth_m = 0;             ///< of its mask; 0 where nothing is measured
  Motion motion;                        ///< unknown in a frame without a pose
};

}  // namespace stillmap
