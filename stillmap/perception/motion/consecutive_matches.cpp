// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/consecutive_matches.hpp"

#include <limits>

namespace stillmap {
namespace {

constexpr double kFarDepthM = 4.0;  // where depth is missing, most often because it is far

/// Where a feature would be, if it stands still; nothing when behind the camera.
std::optional<Eigen::Vector2d> expected_px(const Features& features,
                                           std::size_t i,
                                           const CameraModel& camera,
                                           const Eigen::Isometry3d& T_current_previous) {
  const auto depth = static_cast<double>(features.sensor_depth_m[i]);
  const Eigen::Vector3d p =
      T_current_previous *
      camera.unproject(features.ideal_px[i].cast<double>(), depth > 0 ? depth : kFarDepthM);
  if (!(p.z() > 0)) return std::nullopt;
  return camera.project(p);
}

}  // namespace

std::vector<FeatureMatch> match_consecutive(
    const Features& previous,
    const Features& current,
    const CameraModel& camera,
    const std::optional<Eigen::Isometry3d>& T_current_previous,
    double radius_px,
    const MatchRules& rules) {
  const Eigen::Isometry3d T = T_current_previous.value_or(Eigen::Isometry3d::Identity());
  std::vector<Projection> projections;
  std::vector<std::uint32_t> queries;
  projections.reserve(previous.size());
  for (std::uint32_t i = 0; i < previous.size(); ++i) {
    const std::optional<Eigen::Vector2d> px = expected_px(previous, i, camera, T);
    if (!px) continue;
    const int level = previous.level[i];
    projections.push_back({px->cast<float>(),
                           static_cast<float>(radius_px),
                           0.0F,
                           std::numeric_limits<float>::infinity(),
                           level - 1,
                           level + 1,
                           &previous.descriptors[i]});
    queries.push_back(i);
  }
  std::vector<FeatureMatch> matches = match_projections(projections, current, {}, rules);
  for (FeatureMatch& match : matches) match.query = queries[match.query];
  return keep_consistent_rotations(matches, previous.angle_deg, current.angle_deg);
}

}  // namespace stillmap
