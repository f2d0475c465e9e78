// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/relocalizer.hpp"

#include <algorithm>
#include <unordered_set>

#include "stillmap/core/random.hpp"
#include "stillmap/geometry/ransac.hpp"
#include "stillmap/geometry/rigid_alignment.hpp"
#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/map/landmark_projection.hpp"
#include "stillmap/slam/optim/three_points.hpp"

namespace stillmap {
namespace {

// An image area without features is hidden by a person, or has no texture.
bool has_feature_near(const Features& features, const Eigen::Vector2f& px, float radius_px) {
  bool found = false;
  features.grid.visit_near(px, radius_px, [&](std::uint32_t i) {
    found = found || (features.px[i] - px).squaredNorm() < radius_px * radius_px;
  });
  return found;
}

}  // namespace

Relocalizer::Relocalizer(const RelocalizerConfig& config,
                         const CameraModel& camera,
                         MeasurementModel measure,
                         std::uint32_t seed)
    : config_(config), camera_(camera), measure_(std::move(measure)), seed_(seed) {}

Relocalizer::Match Relocalizer::make_match(const Features& features,
                                           std::uint32_t feature,
                                           LandmarkId landmark,
                                           const Map& map) const {
  return {feature, landmark, {map.landmark(landmark).p_world, measure_(features, feature)}};
}

Relocalizer::Matches Relocalizer::match(const Features& features,
                                        const Keyframe& keyframe,
                                        const Map& map) const {
  const std::vector<FeatureMatch> by_appearance = match_all(
      *keyframe.features, features_with_landmark(keyframe), features, config_.appearance_match);
  Matches matches;
  for (const FeatureMatch& m :
       keep_consistent_rotations(by_appearance, keyframe.features->angle_deg, features.angle_deg)) {
    matches.push_back(make_match(features, m.feature, keyframe.landmarks[m.query], map));
  }
  return matches;
}

Relocalizer::Matches Relocalizer::agreeing(const Matches& matches,
                                           const Eigen::Isometry3d& T_camera_world) const {
  Matches kept;
  std::ranges::copy_if(matches, std::back_inserter(kept), [&](const Match& match) {
    const PoseObservation& seen = match.observation;
    return near_measurement(camera_, seen.measurement, T_camera_world * seen.p_world);
  });
  return kept;
}

// The pose, from three matches with depth, that most matches agree with; nothing where too few do.
std::optional<Eigen::Isometry3d> Relocalizer::sample_pose(FrameId frame,
                                                          const Features& features,
                                                          const Keyframe& keyframe,
                                                          const Matches& matches) const {
  std::vector<std::uint32_t> with_depth;
  for (std::uint32_t i = 0; i < matches.size(); ++i) {
    if (measure_.has_depth(features, matches[i].feature)) with_depth.push_back(i);
  }
  if (with_depth.size() < 3) return std::nullopt;
  const auto count = static_cast<std::uint32_t>(with_depth.size());
  const Eigen::Isometry3d T_keyframe_world = keyframe.T_world_camera.inverse();
  std::mt19937 rng = rng_for(seed_, frame, RandomPurpose::kAbsolutePose);
  const auto pose_of_three = [&]() -> std::optional<Eigen::Isometry3d> {
    const Sample<3> sample = draw_with_replacement<3>(rng, count);
    PointTriple then, now;  // as the key frame and the frame see them
    for (std::size_t i = 0; i < 3; ++i) {
      const Match& pick = matches[with_depth[sample[i]]];
      then[i] = T_keyframe_world * pick.observation.p_world;
      now[i] = camera_.unproject(features.px[pick.feature].cast<double>(),
                                 static_cast<double>(features.depth_m[pick.feature]));
    }
    if (!same_shape(then, now)) return std::nullopt;
    return align_rigid(then, now) * T_keyframe_world;
  };
  const auto best = ransac(config_.iterations,
                           static_cast<std::size_t>(config_.min_matches - 1),
                           pose_of_three,
                           [&](const Eigen::Isometry3d& T) { return agreeing(matches, T).size(); });
  return best ? std::optional(best->model) : std::nullopt;
}

// The landmarks of the key frame first, then those of its neighbours.
std::vector<LandmarkId> Relocalizer::local_landmarks(const Keyframe& keyframe,
                                                     const Map& map) const {
  std::vector<LandmarkId> landmarks;
  std::unordered_set<LandmarkId> known;
  const auto add = [&](const Keyframe& seen_by) {
    for (const LandmarkId id : seen_by.landmarks) {
      if (id.valid() && known.insert(id).second) landmarks.push_back(id);
    }
  };
  add(keyframe);
  int left = config_.local_keyframes - 1;
  for (const CovisibleKeyframe& neighbor : covisible_keyframes(map, keyframe.id)) {
    if (left-- <= 0) break;
    add(map.keyframe(neighbor.id));
  }
  return landmarks;
}

Relocalizer::Matches Relocalizer::search(const Features& features,
                                         const Map& map,
                                         std::span<const LandmarkId> landmarks,
                                         const Eigen::Isometry3d& T_camera_world,
                                         double radius_px) const {
  std::vector<LandmarkId> projected;
  std::vector<Projection> projections;
  for (const LandmarkId id : landmarks) {
    const std::optional<Projection> projection = project_landmark(
        camera_, measure_.level_scales(), T_camera_world, map.landmark(id), radius_px);
    if (!projection) continue;
    projected.push_back(id);
    projections.push_back(*projection);
  }
  Matches matches;
  for (const FeatureMatch& m : match_projections(projections, features, {}, config_.search_match)) {
    matches.push_back(make_match(features, m.feature, projected[m.query], map));
  }
  return matches;
}

Relocalizer::Pose Relocalizer::optimize(const Eigen::Isometry3d& initial,
                                        const Matches& matches) const {
  std::vector<PoseObservation> observations;
  observations.reserve(matches.size());
  for (const Match& match : matches) observations.push_back(match.observation);
  const PoseEstimate estimate = optimize_pose(camera_, initial, observations);
  Pose pose{estimate.T_camera_world, {}};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (estimate.inlier[i] != 0) pose.inliers.push_back(matches[i]);
  }
  return pose;
}

double Relocalizer::share_found(const Features& features,
                                const Map& map,
                                const Keyframe& keyframe,
                                const Pose& pose) const {
  std::unordered_set<LandmarkId> found;
  for (const Match& match : pose.inliers) found.insert(match.landmark);
  const auto near_px = static_cast<float>(camera_.width_px) / 32.0F;
  double expected = 0;
  int seen = 0;
  for (const LandmarkId id : keyframe.landmarks) {
    if (!id.valid()) continue;
    const Landmark& landmark = map.landmark(id);
    const std::optional<Projection> projection =
        project_landmark(camera_, measure_.level_scales(), pose.T_camera_world, landmark, 1.0);
    if (!projection || !has_feature_near(features, projection->px, near_px)) continue;
    // Weighted by the share of frames in which tracking found it when expected.
    expected += (landmark.times_found + 1.0) / (landmark.times_expected + 1.0);
    seen += found.contains(id) ? 1 : 0;
  }
  return expected > 0 ? seen / expected : 0.0;
}

std::optional<Relocalization> Relocalizer::verify(FrameId frame,
                                                  const Features& features,
                                                  const Map& map,
                                                  const Keyframe& keyframe) const {
  const Matches by_appearance = match(features, keyframe, map);
  if (by_appearance.size() < static_cast<std::size_t>(config_.min_matches)) return std::nullopt;
  const std::optional<Eigen::Isometry3d> sampled =
      sample_pose(frame, features, keyframe, by_appearance);
  if (!sampled) return std::nullopt;
  Pose pose = optimize(*sampled, agreeing(by_appearance, *sampled));
  // The first pose may be based on one corner of the image.
  const std::vector<LandmarkId> landmarks = local_landmarks(keyframe, map);
  for (const double radius_px : {config_.search_radius_px, config_.search_radius_px / 2}) {
    pose = optimize(pose.T_camera_world,
                    search(features, map, landmarks, pose.T_camera_world, radius_px));
  }
  if (pose.inliers.size() < static_cast<std::size_t>(config_.min_inliers)) return std::nullopt;
  Relocalization place{pose.T_camera_world, {}, share_found(features, map, keyframe, pose)};
  if (place.share < config_.min_share) return std::nullopt;
  for (const Match& match : pose.inliers) place.matches.emplace_back(match.feature, match.landmark);
  return place;
}

std::optional<Relocalization> Relocalizer::find(FrameId frame,
                                                const Features& features,
                                                const Map& map,
                                                const PlaceIndex& places) const {
  std::optional<Relocalization> best;
  const auto count = static_cast<std::size_t>(config_.candidates);
  for (const PlaceCandidate& candidate : places.query(features.descriptors, count)) {
    std::optional<Relocalization> place =
        verify(frame, features, map, map.keyframe(candidate.keyframe));
    if (!place || (best && place->matches.size() <= best->matches.size())) continue;
    best = std::move(place);
  }
  return best;
}

}  // namespace stillmap
