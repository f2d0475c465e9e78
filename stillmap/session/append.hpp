// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/session/session.hpp"

namespace stillmap {

/// Both sessions in one: ids, submaps and frames of the second follow those of the first, and the
/// submaps are not joined. Camera and settings are those of the first. Both maps must have the same
/// pyramid levels. Throws Error when ids overflow.
[[nodiscard]] Session appended(const Session& first, const Session& second);

}  // namespace stillmap
