// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap {

/// The settings that a session was made with. Throws Error, which begins with `place`, when they
/// are not those of this version.
[[nodiscard]] SystemConfig settings_of(const Session& session, const std::string& place);

/// The map of a submap of the session from its views, as its frames stand now, with the session's
/// settings. Throws Error, which begins with `place`, for settings as above, and when these ask for
/// free space but the views have none.
[[nodiscard]] PointCloud session_cloud(const Session& session,
                                       SubmapId submap,
                                       const std::string& place);

}  // namespace stillmap
