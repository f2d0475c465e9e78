// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tooling/pipeline/object_log.hpp"

namespace stillmap {

/// The bytes of a frame's objects, of all that a log says of them: not their depths and scores.
[[nodiscard]] std::string encode(const LoggedFrame& frame);
[[nodiscard]] LoggedFrame decode_logged_frame(std::string_view bytes);

}  // namespace stillmap
