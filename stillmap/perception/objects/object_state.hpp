// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "stillmap/perception/objects/frame_objects.hpp"

namespace stillmap {

/// The category of a class: whether its objects move (Fan 2020, section III).
enum class Category : std::uint8_t {
  kStatic,              ///< stays where it is
  kPotentiallyDynamic,  ///< moves when a person moves it
  kDynamic,             ///< moves by itself
};

/// The category in words, as in the object log.
[[nodiscard]] std::string_view category_name(Category category);

/// An interval of depths, metres.
struct DepthInterval {
  float min_m = 0;  ///< the nearest depth
  float max_m = 0;  ///< the farthest depth

  /// Whether the two have a depth in common.
  [[nodiscard]] bool overlaps(const DepthInterval& other) const {
    return !(max_m < other.min_m || other.max_m < min_m);
  }
  /// Whether the depth lies in the interval, ends included.
  [[nodiscard]] bool contains(float depth_m) const { return depth_m >= min_m && depth_m <= max_m; }
};

/// The reason why an object is dynamic or static in a frame.
enum class StateReason : std::uint8_t {
  kStaticClass,   ///< static
  kBoxesApart,    ///< static: no person's box intersects its box
  kDepthsApart,   ///< static: a person is before or behind it
  kNotAsked,      ///< static: the mode does not judge interaction
  kDynamicClass,  ///< dynamic: it moves by itself
  kTouching,      ///< dynamic: a person interacts with it
  kDepthUnknown,  ///< dynamic: a person may interact with it
  kMoving,        ///< dynamic: it was observed to move
};
/// The reason in words, as in the object log.
[[nodiscard]] std::string_view reason_name(StateReason reason);

/// What is known of an object's motion.
enum class MotionState : std::uint8_t {
  kUnknown,         ///< seen too seldom, or without depth
  kStill,           ///< it stays where it is
  kMoving,          ///< by itself, as far as is known
  kMovedBySomeone,  ///< moving, and a person interacts with it
};
/// The state in words, as in the object log.
[[nodiscard]] std::string_view motion_name(MotionState state);

/// The motion of an object, in the world frame of the frame's pose.
struct Motion {
  MotionState state = MotionState::kUnknown;  ///< whether it moves
  /// The middle of the visible surface, metres; none without depth.
  std::optional<Eigen::Vector3d> p_world;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< 0 where unknown
  double velocity_error_m_s = 0;                           ///< standard error of its length
  std::optional<TrackId> by;                               ///< the person who moves it
};

/// The state of an object in a frame: its track, whether it is dynamic and why, and its motion.
struct ObjectState {
  TrackId track;           ///< lasting: the same in all frames with the object (ObjectIdentities)
  std::string class_name;  ///< the COCO name if there is one
  Category category = Category::kStatic;           ///< of its class
  bool dynamic = false;                            ///< in this frame
  StateReason reason = StateReason::kStaticClass;  ///< why it is dynamic or not
  std::optional<TrackId> person;  ///< the person who interacts with it, or is before or behind it
  PixelBox box;                   ///< in this frame
  float score = 0;                ///< of the network, when it was detected last
  bool filled = false;            ///< the network missed it in this frame
  std::optional<DepthInterval> depths;  ///< of its mask, outliers removed; metres
  float median_depth_m = 0;             ///< of its mask; 0 without depth
  Motion motion;                        ///< unknown in a frame without a pose
};

/// The place of a thing that probably stands elsewhere now.
struct VacatedPlace {
  TrackId left;           ///< of the object at that place
  TrackId found;          ///< and of the one that it probably is now
  double confidence = 0;  ///< 0 to 1

  /// The confidence from which a place counts as vacated, so that the thing at it is not in the
  /// map.
  static constexpr double kCountsFrom = 0.6;
  /// Whether it counts as vacated.
  [[nodiscard]] bool counts() const { return confidence >= kCountsFrom; }
};

}  // namespace stillmap
