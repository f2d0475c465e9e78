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
  kNone,        ///< masks stay as the network has them
  kBox,         ///< pixels of the box at the object's depths, Fan 2020, Eqs. (2)-(5)
  kConfigured,  ///< as dynamics.extension.variant has it
};

/// How sudden changes of depth are found.
enum class JumpRule : std::uint8_t {
  kNone,
  kPreviousFrame,  ///< against the frame before, pixel by pixel, Fan 2020, Eqs. (6)-(7)
  kWarpedFrames,   ///< against earlier frames warped to the expected pose
};

/// What becomes of features whose depth is missing or not stable (Fan 2020, section III-E).
enum class DepthStabilityRule : std::uint8_t {
  kNone,        ///< nothing is judged
  kDrop,        ///< features of missing and of unstable depth are dropped, spreads compared as is
  kConfigured,  ///< as dynamics.depth_stability has it; features of missing depth stay
};

/// Whether matches in the boxes of dynamic objects are judged by the geometry of two views
/// (Fan 2020, section III-F).
enum class StaticMatchRule : std::uint8_t {
  kNone,
  kJudge,
  kConfigured,  ///< as dynamics.static_matches.in_full has it
};

/// What is removed from a view's depth, and later from the map. The texts are values of the
/// settings cloud.edges, cloud.islands and cloud.free_space, which hold where these say "by_mode".
struct CloudRules {
  std::string_view edges;       ///< depth edges, Fan 2020, Eqs. (11)-(12)
  std::string_view islands;     ///< small patches of depth, Fan 2020, Eq. (13)
  std::string_view free_space;  ///< points that later views see through
};

/// A way to treat what moves: one row of the table in modes.cpp. Every stage reads its own column
/// and knows no mode by name.
struct DynamicsMode {
  std::string_view name;
  std::string_view meaning;          ///< for help texts
  bool judges = true;                ///< false: nothing is done about what moves
  ExtensionRule extension = ExtensionRule::kNone;
  bool interaction = false;          ///< what a person is at is dynamic, Fan 2020, Eqs. (8)-(9)
  JumpRule jumps = JumpRule::kNone;
  bool motion = false;               ///< an object that is seen to move is dynamic
  bool fills_after_one_sighting = false;  ///< Fan 2020, section III-C; else as dynamics.tracker has it
  DepthStabilityRule depth_stability = DepthStabilityRule::kNone;
  StaticMatchRule static_matches = StaticMatchRule::kNone;
  CloudRules cloud;
};

/// All modes, in the order from the least to the most that is done.
[[nodiscard]] std::span<const DynamicsMode> dynamics_modes();

/// The mode of that name. Throws Error with the known names for any other.
[[nodiscard]] const DynamicsMode& dynamics_mode(std::string_view name);

/// Their names, in that order.
[[nodiscard]] std::vector<std::string_view> dynamics_mode_names();

/// The name of the mode that settings begin with.
[[nodiscard]] std::string default_dynamics_mode();

}  // namespace stillmap
