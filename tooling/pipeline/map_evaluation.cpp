// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/map_evaluation.hpp"

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/map_files.hpp"

namespace stillmap {
namespace {

std::optional<std::filesystem::path> if_exists(const std::filesystem::path& file) {
  return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

}  // namespace

std::optional<SequenceTruth> read_sequence_truth(const std::filesystem::path& folder) {
  const std::filesystem::path truth = folder / "truth";
  const std::filesystem::path static_file = truth / "static_map.ply";
  const std::filesystem::path groundtruth = folder / "groundtruth.txt";
  if (!path_exists(groundtruth) || !std::filesystem::exists(static_file)) return std::nullopt;
  return SequenceTruth{
      .groundtruth = read_trajectory(groundtruth),
      .map = read_map_truth(
          static_file, if_exists(truth / "dynamic_map.ply"), if_exists(truth / "resting_map.ply"))};
}

std::optional<MapQuality> run_map_quality(const PointCloud& map,
                                          const Trajectory& estimate,
                                          const SequenceTruth& truth) {
  const std::optional<Eigen::Isometry3d> alignment = map_alignment(truth.groundtruth, estimate);
  if (!alignment) return std::nullopt;
  const PointCloud aligned = moved(map, *alignment);
  check_extent(aligned, "the map, moved to the ground truth");
  return map_quality(aligned, truth.map);
}

}  // namespace stillmap
