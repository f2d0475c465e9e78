// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "stillmap/eval/ate.hpp"
#include "stillmap/eval/rpe.hpp"

namespace stillmap {

/// `{rmse, mean, median, std, min, max, pairs}`, metres; every key null where nothing is known.
[[nodiscard]] nlohmann::ordered_json ate_json(const std::optional<AteResult>& ate);

/// `{delta_s, pairs, trans: {rmse, mean, median, std, min, max}, rot_deg: {the same}}`, seconds,
/// metres and degrees; every key of a figure null where nothing is known.
[[nodiscard]] nlohmann::ordered_json rpe_json(const std::optional<RpeResult>& rpe);

}  // namespace stillmap
