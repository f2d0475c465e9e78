// SPDX-License-Identifier: Apache-2.0
#include "stillmap/tracking/relocalizer.hpp"

#include <algorithm>
#include <array>

#include "stillmap/core/random.hpp"
#include "stillmap/core/rigid_align.hpp"
#include "stillmap/features/matcher.hpp"
#include "stillmap/map/covisibility.hpp"
#include "stillmap/optim/pose_optimizer.hpp"

namespace stillmap {

Relocalizer::Relocalizer(const RelocalizerConfig& config,
                         const CameraModel& camera,
                         MeasurementModel measure,
                         std::uint32_t seed)
    : config_(config), camera_(camera), measure_(std::move(measure)), seed_(seed) {}

std::vector<Relocalizer::Correspondence> Relocalizer::match(const Features& features,
                                                            const Keyframe& keyframe,
                                                            const Map& map) const {
  std::vector<std::uint32_t> with_landmark;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (keyframe.landmarks[i].valid()) with_landmark.push_back(i);
  }
  const std::vector<FeatureMatch> by_appearance = match_all(
      *keyframe.features, with_landmark, features, {.max_distance = 60, .max_ratio = 0.8});
  std::vector<Correspondence> matches;
  for (const FeatureMatch& m :
       keep_consistent_rotations(by_appearance, keyframe.features->angle_deg, features.angle_deg)) {
    const LandmarkId landmark = keyframe.landmarks[m.query];
    const double depth = static_cast<double>(features.depth_m[m.feature]);
    matches.push_back({m.feature,
                       landmark,
                       map.landmark(landmark).p_world,
                       camera_.unproject(features.px[m.feature].cast<double>(), depth),
                       measure_.has_depth(features, m.feature)});
  }
  return matches;
}

// The rigid motion, from three matches with depth, that most matches agree with.
std::optional<Eigen::Isometry3d> Relocalizer::sample_pose(
    FrameId frame, std::span<const Correspondence> matches) const {
  std::vector<const Correspondence*> with_depth;
  for (const Correspondence& match : matches) {
    if (match.has_depth) with_depth.push_back(&match);
  }
  if (with_depth.size() < 3) return std::nullopt;
  std::mt19937 rng = rng_for(seed_, frame, RandomPurpose::kAbsolutePose);
  std::optional<Eigen::Isometry3d> best;
  int best_support = 0;
  for (int iteration = 0; iteration < config_.iterations; ++iteration) {
    std::array<Eigen::Vector3d, 3> world, camera;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto* pick = with_depth[draw_index(rng, static_cast<std::uint32_t>(with_depth.size()))];
      world[i] = pick->p_world;
      camera[i] = pick->p_camera;
    }
    const Eigen::Isometry3d T_camera_world = align_rigid(world, camera);
    int support = 0;
    for (const Correspondence* match : with_depth) {
      const double tolerance = 0.03 * match->p_camera.z();
      support += (T_camera_world * match->p_world - match->p_camera).norm() < tolerance ? 1 : 0;
    }
    if (support > best_support) {
      best_support = support;
      best = T_camera_world;
    }
  }
  return best;
}

std::optional<Relocalization> Relocalizer::find(FrameId frame,
                                                const Features& features,
                                                const Map& map,
                                                const PlaceIndex& places) const {
  const auto count = static_cast<std::size_t>(config_.candidates);
  for (const PlaceCandidate& candidate : places.query(features.descriptors, count)) {
    const std::vector<Correspondence> matches =
        match(features, map.keyframe(candidate.keyframe), map);
    if (matches.size() < static_cast<std::size_t>(config_.min_inliers)) continue;
    const std::optional<Eigen::Isometry3d> sampled = sample_pose(frame, matches);
    if (!sampled) continue;
    std::vector<PoseObservation> observations;
    for (const Correspondence& m : matches) {
      observations.push_back({m.p_world, measure_(features, m.feature)});
    }
    const PoseEstimate estimate = optimize_pose(camera_, *sampled, observations);
    if (estimate.inliers < config_.min_inliers) continue;
    Relocalization found{estimate.T_camera_world, {}};
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (estimate.inlier[i] != 0) {
        found.matches.emplace_back(matches[i].feature, matches[i].landmark);
      }
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace stillmap
