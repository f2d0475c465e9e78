// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "stillmap/core/depth_stamp.hpp"
#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/map/landmark_projection.hpp"
#include "stillmap/slam/optim/pose_time.hpp"
#include "stillmap/slam/optim/time_correction.hpp"

namespace stillmap {
Tracker::Tracker(const TrackerConfig& config,
                 const RelocalizerConfig& relocalizer,
                 const CameraModel& camera,
                 MeasurementModel measure,
                 std::uint32_t seed)
    : config_(config),
      relocalizer_(relocalizer, camera, measure, seed),
      camera_(camera),
      measure_(std::move(measure)) {}

TrackedFrame Tracker::start(const RgbdFrame& frame, FeaturesPtr features) {
  TrackedFrame tracked;
  tracked.id = frame.id;
  tracked.stamp_s = frame.stamp.seconds;
  tracked.status = TrackingStatus::kInitialized;
  tracked.landmarks.assign(features->size(), LandmarkId{});
  Matches own;
  for (std::uint32_t i = 0; i < features->size(); ++i) {
    if (!measure_.has_depth(*features, i)) continue;
    own.push_back({i,
                   {},
                   camera_.unproject(features->px[i].cast<double>(),
                                     static_cast<double>(features->depth_m[i]))});
  }
  tracked.information =
      pose_information(camera_, Eigen::Isometry3d::Identity(), observations_of(*features, own));
  tracked.features = std::move(features);
  last_ = tracked;
  motion_.reset();
  lost_ = false;
  return tracked;
}

TrackedFrame Tracker::track(const RgbdFrame& frame,
                            Features features,
                            const Map& map,
                            const PlaceIndex& places,
                            const MoreFeatures& more) {
  TrackedFrame begun;
  begun.id = frame.id;
  begun.stamp_s = frame.stamp.seconds;
  begun.timing.depth_stamp_s = depth_stamp_after_color_s(frame);
  begun.timing.assumed = times_;
  if (last_) begun.reference = last_->reference;
  Attempt found = attempt(begun, std::move(features), map, places);
  if (more && found.inliers() < config_.enough_inliers) {
    if (std::optional<Features> all = more(found.features)) {
      Attempt second = attempt(begun, *std::move(all), map, places);
      if (confirms(second, found)) found = std::move(second);
    }
  }
  if (!lost_ && !found.pose) {
    locate(found, relocalize(found.frame, found.features, map, places), map);
  }
  auto& [tracked, used, pose] = found;
  if (pose && !lost_) pose = refine_times(tracked, used, *pose, map);
  tracked.inliers = found.inliers();
  tracked.landmarks.assign(used.size(), LandmarkId{});
  tracked.features = std::make_shared<const Features>(std::move(used));
  if (tracked.inliers < config_.min_inliers) {
    lost_ = true;
    motion_.reset();
    return tracked;
  }
  tracked.status = lost_ ? TrackingStatus::kRelocalized : TrackingStatus::kTracked;
  tracked.T_world_camera = pose->T_camera_world.inverse();
  const std::vector<PoseObservation> inliers = observations_of(*tracked.features, pose->inliers);
  tracked.information = pose_information(camera_, pose->T_camera_world, inliers);
  std::vector<double> row;
  row.reserve(inliers.size());
  for (const Match& match : pose->inliers) {
    row.push_back(row_position(tracked.features->raw_px[match.feature], camera_));
  }
  tracked.timing.pose_by_times = pose_by_times(
      camera_, pose->T_camera_world, inliers, row, tracked.timing.velocity, tracked.information);
  for (const Match& match : pose->inliers) tracked.landmarks[match.feature] = match.landmark;
  remember(tracked, map);
  return tracked;
}

// Estimates the pose from the previous frame or, while lost, by relocalisation.
Tracker::Attempt Tracker::attempt(const TrackedFrame& frame,
                                  Features features,
                                  const Map& map,
                                  const PlaceIndex& places) const {
  Attempt result{frame, std::move(features), std::nullopt};
  if (last_) {
    const double since_last_s = frame.stamp_s - last_->stamp_s;
    result.frame.timing.velocity = mean_velocity(motion_.predict(since_last_s), since_last_s);
    result.features = at_pose_time(std::move(result.features), camera_, result.frame.timing);
  }
  locate(
      result,
      lost_ ? relocalize(frame, result.features, map, places) : follow(frame, result.features, map),
      map);
  return result;
}

double Tracker::Attempt::trust() const {
  double sum = 0;
  if (!pose) return sum;
  for (const Match& match : pose->inliers) {
    sum += static_cast<double>(features.trust_of(match.feature));
  }
  return sum;
}

void Tracker::locate(Attempt& attempt,
                     const std::optional<PoseFromMatches>& start,
                     const Map& map) const {
  if (start) attempt.pose = track_local_map(attempt.frame, attempt.features, *start, map);
}

// Features that move together can outnumber the static ones, which must keep their landmarks. Too
// few to be a pose are no witness: without them the trust in all must be that of a pose.
bool Tracker::confirms(const Attempt& with_more, const Attempt& without) const {
  if (with_more.inliers() <= without.inliers()) return false;
  if (without.inliers() < config_.min_inliers && with_more.trust() >= config_.min_inliers) {
    return true;
  }
  const auto shared = std::ranges::count_if(with_more.pose->inliers, [&](const Match& match) {
    return match.feature < without.features.size();
  });
  return static_cast<double>(shared) >= config_.confirmed_share * without.inliers();
}

std::optional<Tracker::PoseFromMatches> Tracker::follow(const TrackedFrame& frame,
                                                        const Features& features,
                                                        const Map& map) const {
  if (auto pose = track_last_frame(frame, features, map)) return pose;
  return track_reference(frame, features, map);
}

std::optional<Tracker::PoseFromMatches> Tracker::relocalize(const TrackedFrame& frame,
                                                            const Features& features,
                                                            const Map& map,
                                                            const PlaceIndex& places) const {
  const std::optional<Relocalization> found = relocalizer_.find(frame.id, features, map, places);
  if (!found) return std::nullopt;
  PoseFromMatches pose{found->T_camera_world, {}};
  for (const auto& [feature, landmark] : found->matches) {
    pose.inliers.push_back({feature, landmark, map.landmark(landmark).p_world});
  }
  return pose;
}

// The features were corrected with the predicted velocity. Now the velocity is known.
Tracker::PoseFromMatches Tracker::refine_times(TrackedFrame& frame,
                                               Features& features,
                                               const PoseFromMatches& pose,
                                               const Map& map) const {
  frame.timing.velocity = mean_velocity(last_pose(map).inverse() * pose.T_camera_world.inverse(),
                                        frame.stamp_s - last_->stamp_s);
  frame.timing.smooth_velocity = frame.timing.velocity;
  features = at_pose_time(std::move(features), camera_, frame.timing);
  return optimize(features, pose.T_camera_world, pose.inliers);
}

void Tracker::set_reference(KeyframeId keyframe, const Map& map) {
  last_->reference = keyframe;
  last_->landmarks = map.keyframe(keyframe).landmarks;
  T_reference_last_ = Eigen::Isometry3d::Identity();
}

Eigen::Isometry3d Tracker::last_pose(const Map& map) const {
  return map.T_world_keyframe(last_->reference) * T_reference_last_;
}

std::optional<Eigen::Isometry3d> Tracker::expected_pose(double stamp_s, const Map& map) const {
  if (lost_ || !last_) return std::nullopt;
  return last_pose(map) * motion_.predict(stamp_s - last_->stamp_s);
}

void Tracker::remember(const TrackedFrame& frame, const Map& map) {
  if (lost_) {
    motion_.reset();
  } else {
    motion_.set(last_pose(map).inverse() * frame.T_world_camera, frame.stamp_s - last_->stamp_s);
  }
  T_reference_last_ = map.T_world_keyframe(frame.reference).inverse() * frame.T_world_camera;
  last_ = frame;
  lost_ = false;
}

std::vector<PoseObservation> Tracker::observations_of(const Features& features,
                                                      const Matches& matches) const {
  std::vector<PoseObservation> observations;
  observations.reserve(matches.size());
  for (const Match& match : matches) {
    observations.push_back({match.p_world,
                            measure_(features, match.feature),
                            static_cast<double>(features.trust_of(match.feature))});
  }
  return observations;
}

Tracker::PoseFromMatches Tracker::optimize(const Features& features,
                                           const Eigen::Isometry3d& initial,
                                           const Matches& matches) const {
  const PoseEstimate estimate = optimize_pose(camera_, initial, observations_of(features, matches));
  PoseFromMatches result{estimate.T_camera_world, {}};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (estimate.inlier[i] != 0) result.inliers.push_back(matches[i]);
  }
  return result;
}

Tracker::Matches Tracker::match_last_frame(const Features& features,
                                           const Map& map,
                                           const Eigen::Isometry3d& T_camera_world,
                                           double radius_px) const {
  const Eigen::Isometry3d T_world_last = last_pose(map);
  const Features& last = *last_->features;
  Matches points;
  std::vector<Projection> projections;
  std::vector<float> angles;
  std::unordered_set<LandmarkId> known;  // landmarks of two features may have been merged since
  for (std::uint32_t i = 0; i < last.size(); ++i) {
    const LandmarkId id = map.resolve(last_->landmarks[i]);
    const bool usable = measure_.has_depth(last, i) && last.trust_of(i) >= kTrustOfLandmarks;
    if (id.valid() ? !known.insert(id).second : !usable) continue;
    const Eigen::Vector3d p_world =
        id.valid() ? map.landmark(id).p_world
                   : T_world_last * camera_.unproject(last.px[i].cast<double>(),
                                                      static_cast<double>(last.depth_m[i]));
    const Eigen::Vector3d p_camera = T_camera_world * p_world;
    if (!in_view(camera_, p_camera)) continue;
    const int level = last.level[i];
    const double scale = static_cast<double>(measure_.level_scales()[last.level[i]]);
    const double inverse_depth = 1.0 / p_camera.z();
    projections.push_back({camera_.project(p_camera).cast<float>(),
                           static_cast<float>(radius_px * scale),
                           static_cast<float>(inverse_depth),
                           inverse_depth_gate(inverse_depth),
                           level - 1,
                           level + 1,
                           &last.descriptors[i]});
    points.push_back({0, id, p_world});
    angles.push_back(last.angle_deg[i]);
  }
  const std::vector<FeatureMatch> found =
      match_projections(projections, features, {}, config_.frame_match);
  Matches matches;
  for (const FeatureMatch& match : keep_consistent_rotations(found, angles, features.angle_deg)) {
    Match point = points[match.query];
    point.feature = match.feature;
    matches.push_back(point);
  }
  return matches;
}

std::optional<Tracker::PoseFromMatches> Tracker::track_last_frame(const TrackedFrame& frame,
                                                                  const Features& features,
                                                                  const Map& map) const {
  const Eigen::Isometry3d T_camera_world = expected_pose(frame.stamp_s, map)->inverse();
  Matches matches = match_last_frame(features, map, T_camera_world, config_.frame_search_radius_px);
  if (std::ssize(matches) < config_.min_frame_matches) {
    matches = match_last_frame(features, map, T_camera_world, 2 * config_.frame_search_radius_px);
  }
  if (std::ssize(matches) < config_.min_frame_matches) return std::nullopt;
  PoseFromMatches pose = optimize(features, T_camera_world, matches);
  if (std::ssize(pose.inliers) < config_.min_frame_inliers) return std::nullopt;
  return pose;
}

std::optional<Tracker::PoseFromMatches> Tracker::track_reference(const TrackedFrame& frame,
                                                                 const Features& features,
                                                                 const Map& map) const {
  const Keyframe& reference = map.keyframe(map.anchor(frame.reference).keyframe);
  const std::vector<FeatureMatch> found = match_all(
      *reference.features, features_with_landmark(reference), features, config_.reference_match);
  Matches matches;
  for (const FeatureMatch& match :
       keep_consistent_rotations(found, reference.features->angle_deg, features.angle_deg)) {
    const LandmarkId id = reference.landmarks[match.query];
    matches.push_back({match.feature, id, map.landmark(id).p_world});
  }
  if (std::ssize(matches) < config_.min_frame_matches) return std::nullopt;
  PoseFromMatches pose = optimize(features, last_pose(map).inverse(), matches);
  if (std::ssize(pose.inliers) < config_.min_frame_inliers) return std::nullopt;
  return pose;
}

// Sets the frame's reference to the key frame that shares most landmarks with it.
std::vector<LandmarkId> Tracker::local_landmarks(TrackedFrame& frame,
                                                 const Matches& matches,
                                                 const Map& map) const {
  std::vector<LandmarkId> seen;
  for (const Match& match : matches) {
    if (match.landmark.valid()) seen.push_back(match.landmark);
  }
  std::vector<CovisibleKeyframe> keyframes = keyframes_seeing(map, seen);
  const KeyframeId nearest =
      keyframes.empty() ? map.anchor(frame.reference).keyframe : keyframes.front().id;
  frame.reference = nearest;
  for (const CovisibleKeyframe& neighbor : covisible_keyframes(map, nearest)) {
    keyframes.push_back(neighbor);
  }
  std::vector<KeyframeId> chosen = {nearest};
  for (const CovisibleKeyframe& keyframe : keyframes) {
    if (std::ssize(chosen) >= config_.local_keyframes) break;
    if (std::ranges::find(chosen, keyframe.id) == chosen.end()) chosen.push_back(keyframe.id);
  }
  std::unordered_set<LandmarkId> known(seen.begin(), seen.end());
  std::vector<LandmarkId> landmarks;
  for (const KeyframeId id : chosen) {
    for (const LandmarkId landmark : map.keyframe(id).landmarks) {
      if (landmark.valid() && known.insert(landmark).second) landmarks.push_back(landmark);
    }
  }
  return landmarks;
}

Tracker::PoseFromMatches Tracker::track_local_map(TrackedFrame& frame,
                                                  const Features& features,
                                                  const PoseFromMatches& start,
                                                  const Map& map) const {
  Matches matches;
  std::vector<std::uint8_t> taken(features.size(), 0);
  for (const Match& match : start.inliers) {
    if (!match.landmark.valid())
      continue;  // a point of the previous frame alone is used for matching only
    matches.push_back(match);
    taken[match.feature] = 1;
    frame.expected.push_back(match.landmark);
  }
  std::vector<LandmarkId> projected;
  std::vector<Projection> projections;
  for (const LandmarkId id : local_landmarks(frame, matches, map)) {
    const std::optional<Projection> projection = project_landmark(camera_,
                                                                  measure_.level_scales(),
                                                                  start.T_camera_world,
                                                                  map.landmark(id),
                                                                  config_.map_search_radius_px);
    if (!projection) continue;
    projected.push_back(id);
    projections.push_back(*projection);
    frame.expected.push_back(id);
  }
  for (const FeatureMatch& match :
       match_projections(projections, features, taken, config_.map_match)) {
    const LandmarkId id = projected[match.query];
    matches.push_back({match.feature, id, map.landmark(id).p_world});
  }
  return optimize(features, start.T_camera_world, matches);
}

}  // namespace stillmap
