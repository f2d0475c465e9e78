// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/modes.hpp"

#include <algorithm>
#include <array>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

// A mode is a row of this table and nothing else. A mode that needs a new rule adds an enumerator
// to the rule's type and a branch to the stage that reads it.
//
// `off` and `mask` remove nothing from the map: they are for comparison. `ds-slam` and `dynaslam`
// treat motion as their articles describe it, inside this system; they are no ports. `paper` has
// the rules and thresholds of Fan 2020. In `full` the threshold of depth edges grows with depth, as
// the sensor's noise does, because a fixed threshold removes far walls. Instead of islands, which
// are mostly chair legs or surface seen between people, `full` removes points that later views see
// through.
constexpr std::array kModes = {
    DynamicsMode{.name = "off",
                 .meaning = "motion is ignored: SLAM for a static world",
                 .judges = false,
                 .cloud = {.edges = "off", .islands = "off", .free_space = "off"}},
    DynamicsMode{.name = "mask",
                 .meaning = "the network's masks of dynamic classes are left out",
                 .cloud = {.edges = "off", .islands = "off", .free_space = "off"}},
    DynamicsMode{.name = "ds-slam",
                 .meaning = "people whose points leave their epipolar lines, after Yu et al. 2018",
                 .masks = MaskRule::kSearched,
                 .static_matches = StaticMatchRule::kObjects,
                 .cloud = {.edges = "off", .islands = "off", .free_space = "off"}},
    DynamicsMode{.name = "dynaslam",
                 .meaning = "masks and what hides earlier points, after Bescos et al. 2018",
                 .jumps = JumpRule::kMultiView,
                 .cloud = {.edges = "off", .islands = "off", .free_space = "off"}},
    DynamicsMode{.name = "paper",
                 .meaning = "the method of Fan et al. 2020",
                 .extension = ExtensionRule::kBox,
                 .masks = MaskRule::kExact,
                 .interaction = true,
                 .jumps = JumpRule::kPreviousFrame,
                 .fills_after_one_sighting = true,
                 .depth_stability = DepthStabilityRule::kDrop,
                 .static_matches = StaticMatchRule::kJudge,
                 .cloud = {.edges = "fixed",
                           .islands = "on",
                           .free_space = "off",
                           .view_frames = "keyframes",
                           .points = "pixels"}},
    DynamicsMode{
        .name = "full",
        .meaning =
            "masks extended by depth, depth jumps over seconds, motion of objects, free space",
        .extension = ExtensionRule::kConfigured,
        .interaction = true,
        .jumps = JumpRule::kWarpedFrames,
        .motion = true,
        .doubts = true,
        .depth_stability = DepthStabilityRule::kConfigured,
        .static_matches = StaticMatchRule::kConfigured,
        .cloud = {.edges = "growing",
                  .islands = "off",
                  .fusion = "surface",
                  .free_space = "on",
                  .missed_people = "on"}},
};

}  // namespace

std::span<const DynamicsMode> dynamics_modes() {
  return kModes;
}

const DynamicsMode& dynamics_mode(std::string_view name) {
  const auto* const mode = std::ranges::find(kModes, name, &DynamicsMode::name);
  if (mode != kModes.end()) return *mode;
  std::vector<std::string> names;
  for (const DynamicsMode& known : kModes) names.emplace_back(known.name);
  throw Error("dynamics.mode: {} is no mode: {}", name, name_hint(name, names));
}

std::vector<std::string_view> dynamics_mode_names() {
  std::vector<std::string_view> names;
  for (const DynamicsMode& mode : kModes) names.push_back(mode.name);
  return names;
}

std::string default_dynamics_mode() {
  return std::string(kModes.back().name);
}

}  // namespace stillmap
