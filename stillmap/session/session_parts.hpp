// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stillmap/session/session.hpp"
#include "stillmap/slam/map/map_parts.hpp"

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

/// Throws Error, in one line that starts with `place`, for all that is not the map, if it refers to
/// nothing or holds what means nothing. See check_parts() and Map::from_parts for the map itself.
void check_records(const SessionParts& parts, const std::string& place);

}  // namespace stillmap
