// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/ate.hpp"

#include <utility>

#include "stillmap/geometry/rigid_alignment.hpp"
#include "tooling/eval/pose_pairs.hpp"

namespace stillmap {

std::optional<AteResult> absolute_trajectory_error(const Trajectory& groundtruth,
                                                   const Trajectory& estimate,
                                                   double max_difference_s) {
  const std::vector<std::pair<std::size_t, std::size_t>> matches =
      pair_poses(groundtruth, estimate, max_difference_s);
  if (matches.size() < 3) return std::nullopt;

  std::vector<Eigen::Vector3d> truth, estimated;
  for (const auto& [i, j] : matches) {
    truth.push_back(groundtruth[i].T_world_camera.translation());
    estimated.push_back(estimate[j].T_world_camera.translation());
  }
  AteResult result;
  result.T_groundtruth_estimate = align_rigid(estimated, truth);
  std::vector<double> errors_m;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const Eigen::Vector3d aligned = result.T_groundtruth_estimate * estimated[k];
    errors_m.push_back((aligned - truth[k]).norm());
    result.pairs.push_back({estimate[matches[k].second].stamp, truth[k], aligned, errors_m.back()});
  }
  result.translation_m = statistics(errors_m);
  return result;
}

std::optional<double> fitted_scale(const Trajectory& groundtruth,
                                   const Trajectory& estimate,
                                   double max_difference_s) {
  // The best rotation is the same at any scale.
  const std::optional<AteResult> rigid =
      absolute_trajectory_error(groundtruth, estimate, max_difference_s);
  if (!rigid) return std::nullopt;
  Eigen::Vector3d truth_mean = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  for (const AtePair& pair : rigid->pairs) {
    truth_mean += pair.groundtruth / static_cast<double>(rigid->pairs.size());
    mean += pair.estimate_aligned / static_cast<double>(rigid->pairs.size());
  }
  double common = 0, own = 0;
  for (const AtePair& pair : rigid->pairs) {
    const Eigen::Vector3d centered = pair.estimate_aligned - mean;
    common += centered.dot(pair.groundtruth - truth_mean);
    own += centered.squaredNorm();
  }
  if (!(own > 0 && common > 0)) return std::nullopt;
  return common / own;
}

}  // namespace stillmap
