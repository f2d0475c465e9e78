// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/scene_names.hpp"

#include <array>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

struct Entry {
  std::string_view name;
  NamedScene scene;
};
constexpr std::array<Entry, 7> kScenes{{
    {"walking_xyz", {PathKind::kXyz, Activity::kWalking, 300}},
    {"walking_rpy", {PathKind::kRpy, Activity::kWalking, 300}},
    {"walking_halfsphere", {PathKind::kHalfsphere, Activity::kWalking, 300}},
    {"walking_static", {PathKind::kStatic, Activity::kWalking, 300}},
    {"sitting_static", {PathKind::kStatic, Activity::kSitting, 300}},
    {"empty", {PathKind::kXyz, Activity::kNone, 300}},
    // One round and a tenth: the end sees what the start saw.
    {"loop", {PathKind::kLoop, Activity::kNone, 660}},
}};

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kScenes) names.emplace_back(entry.name);
  return names;
}

NamedScene named_scene(std::string_view name) {
  for (const Entry& entry : kScenes) {
    if (entry.name == name) return entry.scene;
  }
  throw Error("unknown scene '{}': {}", name, name_hint(name, scene_names()));
}

}  // namespace stillmap
