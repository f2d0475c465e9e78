// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/choreography.hpp"
#include "simulation/synth/camera_path.hpp"

namespace stillmap {

/// A scene that `stillmap synth` knows by name.
struct NamedScene {
  PathKind path = PathKind::kXyz;
  Activity activity = Activity::kNone;
  std::size_t frames = 0;  ///< as many as it takes to see all of it at 30 a second
};

/// Names of all scenes.
[[nodiscard]] std::vector<std::string> scene_names();

/// The scene of a name. Throws Error, with the nearest name, for one that is unknown.
[[nodiscard]] NamedScene named_scene(std::string_view name);

}  // namespace stillmap
