// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/choreography.hpp"
#include "simulation/synth/camera_path.hpp"

namespace stillmap {

/// A named scene.
struct NamedScene {
  PathKind path = PathKind::kXyz;
  Activity activity = Activity::kNone;
  std::size_t frames = 0;  ///< number of frames of the whole scene at 30 per second
};

/// The names of all scenes.
[[nodiscard]] std::vector<std::string> scene_names();

/// The scene `name`. Throws Error, with a hint at the nearest name, for an unknown name.
[[nodiscard]] NamedScene named_scene(std::string_view name);

}  // namespace stillmap
