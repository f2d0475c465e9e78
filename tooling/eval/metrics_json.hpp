// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <nlohmann/json.hpp>

#include "tooling/eval/ate.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/rpe.hpp"
#include "tooling/eval/see_through.hpp"

namespace stillmap {

// The JSON objects of report.json and of printed evaluations. Keys stay in this order; unknown
// values are null.

/// `{rmse, mean, median, std, min, max, pairs}`, metres.
[[nodiscard]] nlohmann::ordered_json ate_json(const std::optional<AteResult>& ate);

/// `{delta_s, pairs, trans: {rmse, mean, median, std, max}, rot_deg: {...}}`, metres and degrees.
[[nodiscard]] nlohmann::ordered_json rpe_json(const std::optional<RpeResult>& rpe);

/// `{sa, da, aa, ha, accuracy_m, completeness_m, completeness_ratio, ghost_ratio, ghost_volume_l,
/// ghost_clusters, off_ratio_5cm, off_ratio_10cm, voxels}`.
[[nodiscard]] nlohmann::ordered_json map_quality_json(const std::optional<MapQuality>& quality);

/// `{ratio, points, seen_through, frames}`.
[[nodiscard]] nlohmann::ordered_json residue_json(const Residue& residue);

/// `{total, tracked, ratio}`: associated pairs of images, poses in the trajectory, their ratio.
[[nodiscard]] nlohmann::ordered_json frames_json(std::size_t total, std::size_t tracked);

}  // namespace stillmap
