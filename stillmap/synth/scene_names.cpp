// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/scene_names.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {

std::vector<std::string> scene_names() {
  return {"walking_xyz",
          "walking_rpy",
          "walking_halfsphere",
          "walking_static",
          "sitting_static",
          "empty",
          "loop"};
}

NamedScene named_scene(std::string_view name) {
  if (name == "empty") return {PathKind::kXyz, 300};
  // One round and a tenth: the end sees what the start saw.
  if (name == "loop") return {PathKind::kLoop, 660};
  const std::vector<std::string> known = scene_names();
  if (std::ranges::find(known, name) == known.end()) {
    throw Error("unknown scene '{}': {}", name, name_hint(name, known));
  }
  throw Error("scene '{}' has people, whom this version cannot render: use 'empty' or 'loop'",
              name);
}

}  // namespace stillmap
