// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "stillmap/session/session.hpp"

namespace stillmap {

/// Throws Error when a session was made with another camera than `camera` or with other pyramid
/// levels. `place` begins the message.
void check_fits(const Session& session,
                const CameraModel& camera,
                const std::vector<float>& level_scales,
                const std::string& place);

struct MergedSessions {
  Session session;        ///< with the first's settings, in its coordinates
  std::size_t loops = 0;  ///< places of the first that the second has seen again
};

/// Two sessions of one room as one: the second's key frames look for places of the first, loops are
/// closed, and all is adjusted together. Nothing when they have no place in common that can be
/// recognised. Throws Error when they do not fit.
[[nodiscard]] std::optional<MergedSessions> merge_sessions(const Session& first,
                                                           const Session& second,
                                                           const std::string& second_name);

}  // namespace stillmap
