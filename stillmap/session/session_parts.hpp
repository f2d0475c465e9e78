// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stillmap/session/session.hpp"
#include "stillmap/slam/map/map_parts.hpp"

namespace stillmap {

/// A session whose map is in parts.
struct SessionParts {
  CameraModel camera;
  std::string config_yaml;
  MapParts map;
  std::vector<LoopEdge> loops;
  FrameRecords frames;
  std::vector<ViewRecord> views;
  std::vector<KnownObject> objects;
};

[[nodiscard]] SessionParts parts_of(const Session& session);

/// Checks everything but the map: throws Error, in one line that begins with `place`, for
/// references to missing items and for impossible values. check_parts() and Map::from_parts check
/// the map.
void check_records(const SessionParts& parts, const std::string& place);

}  // namespace stillmap
