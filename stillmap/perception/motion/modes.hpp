// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

/// How the masks of dynamic objects are extended.
enum class ExtensionRule : std::uint8_t {
  kNone,        ///< masks stay those of the network
  kBox,         ///< pixels of the box at the object's depths (Fan 2020, Eqs. (2)-(5))
  kConfigured,  ///< as dynamics.extension.variant says
};

/// How the extended masks of dynamic objects are applied.
enum class MaskRule : std::uint8_t {
  /// Features are looked for off masks and depth jumps, dynamics.feature_margin_px away from them.
  /// The map leaves the same pixels out.
  kWidened,
  /// Features are looked for off masks, the map leaves out masks and depth jumps, both without a
  /// margin (Fan 2020). With dynamics.search_masks as kSearched.
  kExact,
  /// As kExact, but features are looked for everywhere and judged; then those on masks are dropped.
  kSearched,
};

/// How depth jumps are found.
enum class JumpRule : std::uint8_t {
  kNone,
  /// against the previous frame, pixel by pixel, missing depth being 0 (Fan 2020, Eqs. (6)-(7))
  kPreviousFrame,
  kWarpedFrames,  ///< against earlier frames warped to the predicted pose
  kMultiView,     ///< points of earlier frames that are seen through, grown in depth (Bescos 2018)
};

/// The treatment of features whose depth is missing or unstable (Fan 2020, section III-E).
enum class DepthStabilityRule : std::uint8_t {
  kNone,        ///< features are not judged
  kDrop,        ///< features of missing and of unstable depth are dropped, spreads compared as is
  kConfigured,  ///< if dynamics.depth_stability.in_full; features of missing depth stay
};

/// How matches in the boxes of dynamic objects are judged by epipolar geometry.
enum class StaticMatchRule : std::uint8_t {
  kNone,
  kJudge,       ///< each by itself (Fan 2020, section III-F)
  kObjects,     ///< an object whose matches moved in part is dynamic, others are not (Yu 2018)
  kConfigured,  ///< as dynamics.static_matches.in_full says
};

/// The rules of the dense map: what makes a view, what is removed from its depth and later from the
/// map. The texts are the values of the settings in the group `cloud` that replace "by_mode".
struct CloudRules {
  std::string_view edges;              ///< depth edges, Fan 2020, Eqs. (11)-(12)
  std::string_view islands;            ///< small patches of depth, Fan 2020, Eq. (13)
  std::string_view fusion = "stitch";  ///< views into one cloud: "stitch" or "surface"
  std::string_view free_space;         ///< points that later views see through
  /// Surface where a person that the network missed in the view's frame must have been.
  std::string_view missed_people = "off";
  std::string_view view_frames = "all";  ///< frames that may become views, Fan 2020, Eq. (1)
  std::string_view points = "cells";     ///< points of a view
};

/// A treatment of motion: one row of the table in modes.cpp. Each stage reads its own column and
/// knows no mode by name.
struct DynamicsMode {
  std::string_view name;
  std::string_view meaning;  ///< for help texts
  bool judges = true;        ///< false: motion is ignored
  ExtensionRule extension = ExtensionRule::kNone;
  MaskRule masks = MaskRule::kWidened;
  /// an object that a person interacts with is dynamic (Fan 2020, Eqs. (8)-(9))
  bool interaction = false;
  JumpRule jumps = JumpRule::kNone;
  bool motion = false;  ///< an object that is observed to move is dynamic
  /// features on dynamic objects may contribute to the pose where the rest is not enough
  bool doubts = false;
  /// Fan 2020, section III-C; else as dynamics.tracker says
  bool fills_after_one_sighting = false;
  DepthStabilityRule depth_stability = DepthStabilityRule::kNone;
  StaticMatchRule static_matches = StaticMatchRule::kNone;
  CloudRules cloud;
};

/// All modes, from the simplest to the most complete.
[[nodiscard]] std::span<const DynamicsMode> dynamics_modes();

/// The mode `name`. Throws Error with the known names for an unknown name.
[[nodiscard]] const DynamicsMode& dynamics_mode(std::string_view name);

/// The names of all modes, in that order.
[[nodiscard]] std::vector<std::string_view> dynamics_mode_names();

/// The name of the default mode.
[[nodiscard]] std::string default_dynamics_mode();

}  // namespace stillmap
