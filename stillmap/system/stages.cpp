// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/stages.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "stillmap/core/stopwatch.hpp"
#include "stillmap/slam/features/feature_selection.hpp"

namespace stillmap {
namespace {

const SystemConfig& checked(const SystemConfig& config) {
  config.check();
  return config;
}

// From the odometry frame to the world frame of the frame's pose.
void move_to_world(std::vector<ObjectState>& objects, const Eigen::Isometry3d& T_world_odometry) {
  for (ObjectState& object : objects) {
    Motion& motion = object.motion;
    if (motion.p_world) motion.p_world = T_world_odometry * *motion.p_world;
    motion.velocity_m_s = T_world_odometry.linear() * motion.velocity_m_s;
  }
}

// The features that may be landmarks: those that are more likely to stand than to move, and those
// that have one in `landmarks`, per feature or empty.
std::vector<std::uint8_t> trusted(const Features& features, std::span<const LandmarkId> landmarks) {
  std::vector<std::uint8_t> keep(features.size(), 0);
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const bool known = !landmarks.empty() && landmarks[i].valid();
    keep[i] = known || features.trust_of(i) >= kTrustOfLandmarks ? 1 : 0;
  }
  return keep;
}

// Removes new features that are more likely to move than not: they must not become landmarks.
TrackedFrame without_doubted_newcomers(TrackedFrame tracked, const CameraModel& camera) {
  const Features& features = *tracked.features;
  if (features.trust.empty()) return tracked;
  const std::vector<std::uint8_t> keep = trusted(features, tracked.landmarks);
  std::vector<LandmarkId> landmarks;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] != 0) landmarks.push_back(tracked.landmarks[i]);
  }
  tracked.features = std::make_shared<const Features>(select_features(features, keep, camera));
  tracked.landmarks = std::move(landmarks);
  return tracked;
}

// The marks of the kept and the dropped features.
std::vector<FeatureMark> marks_of(const TrackedFrame& tracked, const FilteredFeatures& features) {
  std::vector<FeatureMark> marks;
  marks.reserve(tracked.landmarks.size() + features.dropped.size());
  for (std::size_t i = 0; i < tracked.landmarks.size(); ++i) {
    const bool doubted = !tracked.features->trust.empty() && tracked.features->trust[i] < 1;
    const FeatureVerdict judged =
        i < features.verdicts.size() ? features.verdicts[i] : FeatureVerdict::kStable;
    const FeatureVerdict verdict = doubted ? FeatureVerdict::kDoubted : judged;
    marks.push_back({tracked.features->raw_px[i], verdict, tracked.landmarks[i].valid()});
  }
  for (const RejectedFeature& dropped : features.dropped) {
    marks.push_back({dropped.raw_px, dropped.verdict, false});
  }
  return marks;
}

}  // namespace

System::Stages::Stages(const SystemConfig& settings,
                       const CameraModel& camera_model,
                       const SystemOptions& options)
    : config(checked(settings)),
      camera(camera_model),
      threads(static_cast<std::size_t>(std::max(options.threads, 1))),
      localize_only(options.localize_only),
      probe(options.probe),
      observers(options.observers),
      snapshot_every_frames(options.snapshot_every_frames),
      workers(options.threads > 1),
      dynamics(make_dynamics_stage(config.dynamics, camera, config.seed)),
      extractor(config.tracking.orb, camera),
      measure(config.measurement, extractor.level_scales()),
      tracker(config.tracking.tracker, config.relocalization, camera, measure, config.seed),
      back_end(config, camera, measure, workers, options.probe) {}

PreparedFrame System::Stages::prepare(FramePtr frame, FrameObjects objects) const {
  begin_work(probe, Stage::kPreparation);
  Stopwatch stage;
  PreparedFrame prepared;
  prepared.frame = std::move(frame);
  prepared.objects = std::move(objects);
  prepared.corners = extractor.corners(prepared.frame->gray);
  prepared.corners_ms = stage.lap_ms();
  prepared.measured = dynamics->measure(*prepared.frame, prepared.objects);
  prepared.objects_ms = stage.lap_ms();
  return prepared;
}

void System::Stages::apply_finished_work() {
  begin_work(probe, Stage::kTracking);
  back_end.apply_finished_work(frame_number);
  tracker.assume(back_end.times());
}

std::optional<Eigen::Isometry3d> System::Stages::expected_pose(const RgbdFrame& frame) const {
  std::optional<Eigen::Isometry3d> expected =
      tracker.expected_pose(frame.stamp.seconds, back_end.map());
  if (expected) expected = back_end.T_odometry_world() * *expected;
  return expected;
}

// True at the first frames, and when tracking has been lost for long.
bool System::Stages::needs_own_objects() const {
  if (localize_only) return false;
  const bool long_lost = lost_frames >= config.relocalization.new_world_after_frames;
  return back_end.map().keyframes().empty() || long_lost;
}

int System::Stages::count_with_depth(const Features& features) const {
  int with_depth = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    with_depth += measure.has_depth(features, i) ? 1 : 0;
  }
  return with_depth;
}

FeaturesPtr System::Stages::features_to_begin(FeaturesPtr own, const MoreFeatures& more) const {
  const TrackerConfig& needs = config.tracking.tracker;
  if (count_with_depth(*own) >= needs.enough_inliers) return own;
  std::optional<Features> all = more(*own);
  if (!all) return own;
  Features standing = select_features(*all, trusted(*all, {}), camera);
  const bool suffice = count_with_depth(standing) >= needs.min_inliers;
  return std::make_shared<const Features>(suffice ? std::move(standing) : *std::move(all));
}

std::optional<Features> System::Stages::with_doubted(const PreparedFrame& prepared,
                                                     const Features& features,
                                                     const FrameDynamics& judged) const {
  const std::optional<DoubtedPixels> pixels = dynamics->doubted(judged);
  if (!pixels) return std::nullopt;
  Features further = extractor.extract(prepared.corners, prepared.frame->depth, pixels->others);
  for (const Eigen::Vector2f& raw : further.raw_px) {
    const Eigen::Vector2i px = raw.array().round().cast<int>();
    further.trust.push_back(pixels->trust(px.y(), px.x()));
  }
  return joined_features(features, further, camera);
}

TrackedFrame System::Stages::track(const PreparedFrame& prepared,
                                   Features features,
                                   const FrameDynamics& judged,
                                   MaskOrigin origin) {
  const RgbdFrame& frame = *prepared.frame;
  const MoreFeatures more = [&](const Features& own) {
    return with_doubted(prepared, own, judged);
  };
  TrackedFrame tracked =
      tracker.track(frame, std::move(features), back_end.map(), back_end.places(), more);
  if (!has_pose(tracked) && origin == MaskOrigin::kOwn && needs_own_objects()) {
    const FeaturesPtr begun = features_to_begin(tracked.features, more);
    if (count_with_depth(*begun) >= config.tracking.tracker.min_inliers) {
      return tracker.start(frame, begun);
    }
  }
  if (!localize_only) back_end.count_landmarks(tracked);
  return tracked;
}

bool System::Stages::insert_if_keyframe(const RgbdFrame& frame,
                                        TrackedFrame& tracked,
                                        MaskOrigin origin) {
  since_keyframe.most_inliers = std::max(since_keyframe.most_inliers, tracked.inliers);
  ++since_keyframe.frames;
  const bool may = origin == MaskOrigin::kOwn && !localize_only;
  const bool begins = tracked.status == TrackingStatus::kInitialized;
  if (!begins &&
      !(may && wants_keyframe(config.keyframe, tracked, since_keyframe, back_end.map()))) {
    return false;
  }
  if (!begins) tracked = without_doubted_newcomers(std::move(tracked), camera);
  tracked.reference = insert_keyframe(frame, tracked);
  tracker.set_reference(tracked.reference, back_end.map());
  return true;
}

KeyframeId System::Stages::insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked) {
  since_keyframe = {};
  return back_end.insert_keyframe(frame, tracked, frame_number);
}

FrameResult System::Stages::remember(const Outcome& outcome) {
  const auto& [frame, judged, tracked, features, origin, is_keyframe] = outcome;
  FrameResult result;
  result.id = frame->id;
  result.stamp = frame->stamp;
  result.status = tracked.status;
  result.T_world_camera = tracked.T_world_camera;
  result.is_keyframe = is_keyframe;
  result.tracked_features = tracked.inliers;
  result.features = marks_of(tracked, features);
  result.match_judge = features.judge;
  result.object_mask = judged.objects.mask;
  result.network_mask = judged.judged.mask.raw;
  result.extended_mask = judged.judged.mask.extended;
  result.depth_jumps = Mask(judged.judged.mask.jumps.mat);
  result.excluded = judged.excluded_from_pose;

  lost_frames = has_pose(tracked) ? 0 : lost_frames + 1;
  if (!has_pose(tracked)) {
    back_end.lost();
    dynamics->forget();
    result.objects = judged.judged.states;
  } else {
    if (back_end.is_in_loaded(tracked.reference)) {
      dynamics->place_known_objects(back_end.T_odometry_world(), frame->stamp.seconds);
    }
    const std::size_t record = back_end.record(*frame, tracked);
    back_end.remember_movers(frame->stamp.seconds, judged.movers);
    if (!localize_only && origin == MaskOrigin::kOwn) {
      back_end.add_view({frame, judged, record, is_keyframe}, frame_number);
    }
    if (!localize_only && origin == MaskOrigin::kAwaited) {
      late_objects.await({frame, tracked, record});
    }
    const Eigen::Isometry3d T_odometry_camera =
        back_end.T_odometry_world() * tracked.T_world_camera;
    result.objects = dynamics->with_motion(*frame, T_odometry_camera, judged);
    move_to_world(result.objects, back_end.T_odometry_world().inverse());
    dynamics->remember(*frame, T_odometry_camera, judged);
  }
  ++frame_number;
  return result;
}

BackEnd::KnownObjects System::Stages::known_objects() const {
  return [this](const Eigen::Isometry3d& T_odometry_world) {
    return dynamics->known_objects(T_odometry_world);
  };
}

PointCloud System::Stages::map_snapshot() const {
  return back_end.map_snapshot(known_objects(), threads);
}

void System::Stages::notify(const RgbdFrame& frame, const FrameResult& result) {
  for (Observer* observer : observers) {
    observer->on_frame(frame, result);
    if (result.is_keyframe) observer->on_keyframe(result);
  }
  const bool due = snapshot_every_frames > 0 && frame_number % snapshot_every_frames == 0;
  if (!due || observers.empty()) return;
  const PointCloud map = map_snapshot();
  for (Observer* observer : observers) observer->on_map(map, frame_number);
}

void System::Stages::take_objects(FrameObjects objects) {
  std::optional<LateObjects::Awaiting> awaiting = late_objects.take(objects.frame);
  if (!awaiting) return;
  back_end.apply_finished_work(frame_number);
  tracker.assume(back_end.times());
  const RgbdFrame& frame = *awaiting->frame;
  awaiting->tracked.T_world_camera = back_end.T_world_camera(awaiting->record);
  const Eigen::Isometry3d T_odometry_camera =
      back_end.T_odometry_world() * awaiting->tracked.T_world_camera;
  const MeasuredObjects measured = dynamics->measure(frame, objects);
  const FrameDynamics judged =
      dynamics->judge(frame, std::move(objects), measured, T_odometry_camera);
  (void)dynamics->with_motion(frame, T_odometry_camera, judged);  // for the frames to come
  back_end.remember_movers(frame.stamp.seconds, judged.movers);
  const TrackedFrame tracked = without_excluded_features(
      awaiting->tracked, judged.excluded_from_pose, back_end.map(), camera);
  const bool is_keyframe = wants_keyframe(config.keyframe, tracked, since_keyframe, back_end.map());
  if (is_keyframe) {
    back_end.refer_to_keyframe(awaiting->record, insert_keyframe(frame, tracked));
  }
  back_end.add_view({awaiting->frame, judged, awaiting->record, is_keyframe}, frame_number);
}

}  // namespace stillmap
