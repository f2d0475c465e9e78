// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "stillmap/core/point_cloud.hpp"
#include "tooling/eval/map_quality.hpp"

namespace stillmap {

/// Reads a PLY that passes check_extent(). Throws Error naming the file.
[[nodiscard]] PointCloud read_map(const std::filesystem::path& file);

/// Reads the true surfaces. Throws Error naming the file, also for a static surface without points.
[[nodiscard]] MapTruth read_map_truth(
    const std::filesystem::path& static_file,
    const std::optional<std::filesystem::path>& dynamic_file,
    const std::optional<std::filesystem::path>& resting_file = {});

}  // namespace stillmap
