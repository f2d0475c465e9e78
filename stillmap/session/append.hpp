// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/session/session.hpp"

namespace stillmap {

/// Both sessions as one: the second's ids, submaps and frames follow the first's, nothing ties them
/// yet. Camera and settings are the first's. Both maps have the same pyramid levels. Throws Error
/// when there are more than ids can count.
[[nodiscard]] Session appended(const Session& first, const Session& second);

}  // namespace stillmap
