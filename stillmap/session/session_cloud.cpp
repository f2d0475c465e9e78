// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_cloud.hpp"

#include <span>
#include <vector>

#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/dense/vacated_places.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {

SystemConfig settings_of(const Session& session, const std::string& place) {
  SystemConfig config;
  // A map outlives the settings of the version that made it.
  load_yaml_text(
      list_fields(config), session.config_yaml, place + ": settings", UnknownKeys::kSkip);
  return config;
}

PointCloud session_cloud(const Session& session, SubmapId submap, const std::string& place) {
  const SystemConfig settings = settings_of(session, place);
  const CloudConfig config =
      settings.cloud.resolved_for(dynamics_mode(settings.dynamics.mode).cloud);
  for (const ViewRecord& record : session.views) {
    if (submap_of(session, session.frames[record.frame]) != submap) continue;
    if (config.free_space == "on" && record.view->range.cells.empty()) {
      throw Error(
          "{}: invalid view of frame {}: it knows no free space, which cloud.free_space "
          "asks for",
          place,
          record.frame);
    }
  }
  const CategoryTable categories(settings.dynamics.objects.categories);
  std::span<const KnownObject> objects;  // in the frame of the main submap
  if (submap == main_submap(session)) objects = session.objects;
  return map_without_vacated(
             posed_views(session, submap), objects, categories, session.camera, config)
      .points;
}

}  // namespace stillmap
