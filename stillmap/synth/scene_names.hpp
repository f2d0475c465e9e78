// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/synth/camera_path.hpp"

namespace stillmap {

/// A scene that `stillmap synth` knows by name.
struct NamedScene {
  PathKind path = PathKind::kXyz;
  std::size_t frames = 0;  ///< as many as it takes to see all of it at 30 a second
};

/// Names of all scenes, those with people included.
[[nodiscard]] std::vector<std::string> scene_names();

/// The scene of a name: `empty` or `loop`. Throws Error for a scene with people, which this version
/// cannot render, and for a name that is unknown.
[[nodiscard]] NamedScene named_scene(std::string_view name);

}  // namespace stillmap
