// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "tooling/eval/map_quality.hpp"

namespace stillmap {

/// What a rendered sequence tells of its world, all in one frame.
struct SequenceTruth {
  Trajectory groundtruth;
  MapTruth map;
};

/// From groundtruth.txt, truth/static_map.ply in the sequence's folder and, where it is,
/// truth/dynamic_map.ply; nothing when one of the first two is not there. Throws Error for a file
/// that is broken or absurd, and for a static map without points.
[[nodiscard]] std::optional<SequenceTruth> read_sequence_truth(const std::filesystem::path& folder);

/// How good the map of a run is; `estimate` is the run's trajectory and says where the map lies.
/// Nothing when too few of its stamps are known to the ground truth. Throws Error for a map with
/// points beyond kMapExtent_m.
[[nodiscard]] std::optional<MapQuality> run_map_quality(const PointCloud& map,
                                                        const Trajectory& estimate,
                                                        const SequenceTruth& truth);

}  // namespace stillmap
