// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stillmap/map/map_parts.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// A session with its map in parts.
struct SessionParts {
  CameraModel camera;
  std::string config_yaml;
  MapParts map;
  std::vector<LoopEdge> loops;
  std::vector<FrameRecord> frames;
  std::vector<ViewRecord> views;
};

[[nodiscard]] SessionParts parts_of(const Session& session);

/// Throws Error, in one line that starts with `place`, for parts of no session: those of no map,
/// and records that refer to nothing or hold what means nothing.
void check_parts(const SessionParts& parts, const std::string& place);

}  // namespace stillmap
