// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "tooling/eval/map_quality.hpp"

namespace stillmap {

/// The truth of a rendered sequence, all in one coordinate frame.
struct SequenceTruth {
  Trajectory groundtruth;
  MapTruth map;
};

/// From groundtruth.txt, truth/static_map.ply and, where they exist, truth/dynamic_map.ply and
/// truth/resting_map.ply in the sequence's folder; nothing when one of the first two is missing.
/// Throws Error for a broken file or absurd values, and for a static map without points.
[[nodiscard]] std::optional<SequenceTruth> read_sequence_truth(const std::filesystem::path& folder);

/// The quality of a run's map; `estimate` is the run's trajectory, by which the map is aligned.
/// Nothing when the ground truth has too few of its stamps. Throws Error for a map with points
/// beyond kMapExtent_m.
[[nodiscard]] std::optional<MapQuality> run_map_quality(const PointCloud& map,
                                                        const Trajectory& estimate,
                                                        const SequenceTruth& truth);

}  // namespace stillmap
