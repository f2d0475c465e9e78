// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap {

/// The settings of a session. Throws Error, beginning with `place`, when this version does not know
/// them.
[[nodiscard]] SystemConfig settings_of(const Session& session, const std::string& place);

/// The dense map of a submap, made of the views of the session under the present poses, with the
/// settings of the session. Throws Error, beginning with `place`, for unknown settings, and when
/// the settings ask for free space but the views have no range images.
[[nodiscard]] PointCloud session_cloud(const Session& session,
                                       SubmapId submap,
                                       const std::string& place);

}  // namespace stillmap
