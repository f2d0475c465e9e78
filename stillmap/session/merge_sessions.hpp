// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "stillmap/session/session.hpp"

namespace stillmap {

/// Throws Error, beginning with `place`, when a session was made with another camera than `camera`
/// or with other pyramid levels.
void check_fits(const Session& session,
                const CameraModel& camera,
                const std::vector<float>& level_scales,
                const std::string& place);

struct MergedSessions {
  Session session;        ///< with the settings and in the coordinates of the first
  std::size_t loops = 0;  ///< number of places of the first that the second recognised
};

/// Merges two sessions of one room: the key frames of the second look for places of the first,
/// loops are closed, and all key frames are adjusted together. Nothing when no common place is
/// recognised. Throws Error when cameras or pyramid levels differ.
[[nodiscard]] std::optional<MergedSessions> merge_sessions(const Session& first,
                                                           const Session& second,
                                                           const std::string& second_name);

}  // namespace stillmap
