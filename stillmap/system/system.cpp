// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/system.hpp"

#include <algorithm>
#include <set>

#include "stillmap/core/error.hpp"
#include "stillmap/core/stopwatch.hpp"
#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/session/session_map.hpp"
#include "stillmap/slam/features/feature_selection.hpp"

namespace stillmap {
namespace {

const SystemConfig& checked(const SystemConfig& config) {
  config.check();
  return config;
}

constexpr std::size_t kMostAwaiting = 30;             // frames; their images are held
constexpr std::int64_t kEnd = std::int64_t{1} << 62;  // after all frames, and what they lead to

}  // namespace

System::System(const SystemConfig& config, const CameraModel& camera, const SystemOptions& options)
    : config_(checked(config)),
      cloud_config_(config.cloud.resolved_for(config.dynamics.mode)),
      camera_(camera),
      threads_(static_cast<std::size_t>(std::max(options.threads, 1))),
      localize_only_(options.localize_only),
      probe_(options.probe),
      dynamics_(config.dynamics, camera, config.seed),
      extractor_(config.tracking.orb, camera),
      measure_(config.measurement, extractor_.level_scales()),
      session_{camera, {}, Map(extractor_.level_scales()), {}, {}, {}},
      tracker_(config.tracking.tracker, config.relocalization, camera, measure_, config.seed),
      worker_(options.threads > 1 ? std::make_unique<Worker>() : nullptr),
      mapping_jobs_(worker_.get(), [probe = options.probe] { begin_work(probe, Stage::kMapping); }),
      views_(cloud_config_, camera, {options.threads > 1, options.probe}),
      loops_(config.loop,
             camera,
             loop_measurement_model(config, extractor_.level_scales()),
             config.seed,
             {options.threads > 1, options.probe}) {}

void System::load(Session session) {
  STILLMAP_CHECK(frame_number_ == 0);
  check_fits(session, camera_, extractor_.level_scales(), "the saved map");
  const auto knows_free_space = [](const ViewRecord& v) { return !v.view->range.cells.empty(); };
  if (cloud_config_.free_space == "on" && !std::ranges::all_of(session.views, knows_free_space)) {
    throw Error(
        "the saved map has views that know no free space, which these settings ask for: run with "
        "its own dynamics.mode, or with cloud.free_space=off");
  }
  session_ = std::move(session);
  first_frame_ = session_.frames.size();
  loops_.set_places(index_of(session_.map));
  const std::vector<SubmapId> submaps = session_.map.submaps();
  if (!submaps.empty()) next_submap_ = SubmapId(submaps.back().value + 1);
}

PreparedFrame System::prepare(const RgbdFrame& frame, const FrameObjects& objects) const {
  begin_work(probe_, Stage::kPreparation);
  Stopwatch stage;
  PreparedFrame prepared;
  prepared.corners = extractor_.corners(frame.gray);
  prepared.corners_ms = stage.lap_ms();
  if (dynamics_.enabled()) prepared.objects = dynamics_.measure(frame, objects);
  prepared.objects_ms = stage.lap_ms();
  return prepared;
}

FrameResult System::process(const FramePtr& frame, FrameObjects objects, MaskOrigin origin) {
  PreparedFrame prepared = prepare(*frame, objects);
  return process(frame, std::move(objects), std::move(prepared), origin);
}

FrameResult System::process(const FramePtr& frame,
                            FrameObjects objects,
                            PreparedFrame prepared,
                            MaskOrigin origin) {
  begin_work(probe_, Stage::kTracking);
  Stopwatch total, stage;
  FrameResult result;
  update_map(frame_number_);
  result.stages.push_back({"mapping", stage.lap_ms()});

  std::optional<Eigen::Isometry3d> expected =
      tracker_.expected_pose(frame->stamp.seconds, session_.map);
  if (expected) expected = T_odometry_world_ * *expected;
  if (dynamics_.enabled()) {
    result.dynamics = dynamics_.judge(*frame, std::move(objects), prepared.objects, expected);
    result.stages.push_back({"dynamics", prepared.objects_ms + stage.lap_ms()});
  }
  Features features =
      extractor_.extract(std::move(prepared.corners), frame->depth, result.dynamics.excluded);
  result.stages.push_back({"features", prepared.corners_ms + stage.lap_ms()});
  if (dynamics_.enabled()) {
    FilteredFeatures filtered =
        dynamics_.filter(*frame, std::move(features), result.dynamics, expected);
    features = std::move(filtered.features);
    result.dynamics.verdicts = std::move(filtered.verdicts);
    result.dynamics.dropped = std::move(filtered.dropped);
    result.stages.push_back({"feature filter", stage.lap_ms()});
  }

  result.tracked = track(*frame, std::move(features), origin);
  result.stages.push_back({"tracking", stage.lap_ms()});
  result.pose_ms = prepared.corners_ms + prepared.objects_ms + total.lap_ms();

  TrackedFrame& tracked = result.tracked;
  since_keyframe_.most_inliers = std::max(since_keyframe_.most_inliers, tracked.inliers);
  ++since_keyframe_.frames;
  if (tracked.status == TrackingStatus::kInitialized ||
      (origin == MaskOrigin::kOwn && !localize_only_ &&
       wants_keyframe(config_.keyframe, tracked, since_keyframe_, session_.map))) {
    tracked.reference = insert_keyframe(*frame, tracked);
    tracker_.set_reference(tracked.reference, session_.map);
    result.is_keyframe = true;
  }
  remember(frame, result, origin);
  result.stages.push_back({"keyframe", stage.lap_ms()});
  ++frame_number_;
  return result;
}

// What mapping and loop closing have come to. Only one key frame's mapping is under way at a time,
// so that none is when the map is moved.
void System::update_map(std::int64_t frame) {
  const auto last_pose = [&] {
    return session_.frames.empty() ? Eigen::Isometry3d::Identity()
                                   : T_world_frame(session_, session_.frames.back());
  };
  const Eigen::Isometry3d T_world_last = last_pose();
  bool moved = false;
  for (const MapUpdate& update : mapping_jobs_.collect_due(frame)) {
    apply(update);
    if (!loops_.close(
            session_.map, session_.loops, session_.map.keyframes().rbegin()->first, frame))
      continue;
    const LoopEdge& loop = session_.loops.back();
    closed_loops_.push_back(
        {session_.map.keyframe(loop.a).stamp, session_.map.keyframe(loop.b).stamp});
    moved = true;
  }
  if (mapping_jobs_.empty()) moved = loops_.apply_due(session_.map, frame) || moved;
  if (moved) T_odometry_world_ = T_odometry_world_ * T_world_last * last_pose().inverse();
  views_.collect_due(session_, frame);
}

void System::apply(const MapUpdate& update) {
  session_.map.apply(update);
  for (const auto& [dropped, anchor] : update.dropped_keyframes) loops_.remove_keyframe(dropped);
}

// At the first frames, and when nothing known has been seen for long.
bool System::needs_own_objects() const {
  if (localize_only_) return false;
  const bool long_lost = lost_frames_ >= config_.relocalization.new_world_after_frames;
  return session_.map.keyframes().empty() || long_lost;
}

bool System::may_begin_submap(const Features& features) const {
  if (!needs_own_objects()) return false;
  int with_depth = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    with_depth += measure_.has_depth(features, i) ? 1 : 0;
  }
  return with_depth >= config_.tracking.tracker.min_inliers;
}

TrackedFrame System::track(const RgbdFrame& frame, Features features, MaskOrigin origin) {
  TrackedFrame tracked = tracker_.track(frame, std::move(features), session_.map, loops_.places());
  if (!has_pose(tracked) && origin == MaskOrigin::kOwn && may_begin_submap(*tracked.features)) {
    return tracker_.start(frame, tracked.features);
  }
  if (!localize_only_) count_landmarks(tracked);
  return tracked;
}

void System::count_landmarks(const TrackedFrame& tracked) {
  if (!has_pose(tracked)) return;
  for (const LandmarkId id : tracked.expected) session_.map.count_expected(id);
  for (const LandmarkId id : tracked.landmarks) {
    if (id.valid()) session_.map.count_found(id);
  }
}

KeyframeId System::insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked) {
  Map& map = session_.map;
  Keyframe keyframe;
  keyframe.frame = frame.id;
  keyframe.stamp = frame.stamp;
  if (tracked.status == TrackingStatus::kInitialized) {
    keyframe.submap = next_submap_;
    next_submap_ = SubmapId(next_submap_.value + 1);
  } else {
    keyframe.submap = map.keyframe(map.anchor(tracked.reference).keyframe).submap;
  }
  keyframe.T_world_camera = tracked.T_world_camera;
  keyframe.features = tracked.features;
  const KeyframeId id = map.add_keyframe(std::move(keyframe));
  for (std::uint32_t i = 0; i < tracked.landmarks.size(); ++i) {
    if (!tracked.landmarks[i].valid()) continue;
    map.add_observation(tracked.landmarks[i], {id, i});
    map.refresh(tracked.landmarks[i]);
  }
  create_landmarks_from_depth(map, id, camera_, measure_, config_.mapping.creation);
  (void)map.take_changes();  // the owner knows them; only windows hand changes on
  loops_.add_keyframe(map.keyframe(id));
  since_keyframe_ = {};

  std::vector<KeyframeId> core = mapping_core(map, id, config_.mapping);
  auto window = std::make_shared<Map>(map.window(core));
  mapping_jobs_.submit(
      frame_number_ + config_.mapping.lag_frames, [window, core = std::move(core), this] {
        return map_locally(std::move(*window), core, camera_, measure_, config_.mapping);
      });
  return id;
}

void System::take_objects(FrameObjects objects) {
  while (!awaiting_.empty() && awaiting_.front().frame->id < objects.frame) awaiting_.pop_front();
  if (awaiting_.empty() || awaiting_.front().frame->id != objects.frame) return;
  AwaitingObjects awaiting = std::move(awaiting_.front());
  awaiting_.pop_front();
  update_map(frame_number_);

  FrameRecord& record = session_.frames[awaiting.record];
  const RgbdFrame& frame = *awaiting.frame;
  awaiting.tracked.T_world_camera = T_world_frame(session_, record);
  FrameDynamics dynamics;
  if (dynamics_.enabled()) {
    const Eigen::Isometry3d T = T_odometry_world_ * awaiting.tracked.T_world_camera;
    dynamics = dynamics_.judge(frame, std::move(objects), T);
    dynamics_.learn_motions(frame, T, dynamics);
  }
  const TrackedFrame tracked = without_masked_features(awaiting, dynamics.excluded);
  const bool is_keyframe = wants_keyframe(config_.keyframe, tracked, since_keyframe_, session_.map);
  if (is_keyframe) record = {frame.stamp, insert_keyframe(frame, tracked)};
  views_.add({awaiting.frame, dynamics, awaiting.record, is_keyframe}, frame_number_);
}

// The frame as it would be had it come with these masks, its landmarks as the map has them now.
TrackedFrame System::without_masked_features(const AwaitingObjects& awaiting,
                                             const cv::Mat1b& excluded) const {
  TrackedFrame tracked = awaiting.tracked;
  const Features& features = *tracked.features;
  std::vector<std::uint8_t> keep(features.size(), 1);
  for (std::size_t i = 0; i < keep.size() && !excluded.empty(); ++i) {
    const Eigen::Vector2i px = features.raw_px[i].array().round().cast<int>();
    keep[i] = excluded(px.y(), px.x()) == 0 ? 1 : 0;
  }
  std::vector<LandmarkId> landmarks;
  std::set<LandmarkId> seen;  // two may have been merged since
  tracked.inliers = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] == 0) continue;
    const LandmarkId id = session_.map.resolve(tracked.landmarks[i]);
    const bool is_first = id.valid() && seen.insert(id).second;
    landmarks.push_back(is_first ? id : LandmarkId{});
    tracked.inliers += is_first ? 1 : 0;
  }
  tracked.landmarks = std::move(landmarks);
  tracked.features = std::make_shared<const Features>(select_features(features, keep, camera_));
  return tracked;
}

// The frame's place in the session, and what later frames are compared with.
void System::remember(const FramePtr& frame, FrameResult& result, MaskOrigin origin) {
  const TrackedFrame& tracked = result.tracked;
  lost_frames_ = has_pose(tracked) ? 0 : lost_frames_ + 1;
  if (!has_pose(tracked)) {
    loops_.tracking_lost();
    dynamics_.forget();
    return;
  }
  session_.frames.push_back(
      {frame->stamp,
       tracked.reference,
       session_.map.T_world_keyframe(tracked.reference).inverse() * tracked.T_world_camera});
  const std::size_t record = session_.frames.size() - 1;
  if (!localize_only_ && origin == MaskOrigin::kOwn) {
    views_.add({frame, result.dynamics, record, result.is_keyframe}, frame_number_);
  }
  if (!localize_only_ && origin == MaskOrigin::kAwaited) {
    awaiting_.push_back({frame, tracked, record});
    if (awaiting_.size() > kMostAwaiting) awaiting_.pop_front();
  }
  if (dynamics_.enabled()) {
    dynamics_.remember(*frame, T_odometry_world_ * tracked.T_world_camera, result.dynamics);
  }
}

RunResult System::finish() {
  update_map(kEnd);  // which may begin another adjustment
  loops_.finish(session_.map, main_submap(session_, first_frame_));
  session_.camera.readout_s = readout_s();

  RunResult result;
  result.lost_at_end = lost_frames_ > 0 || frame_number_ == 0;
  SubmapId submap = main_submap(session_, first_frame_);
  if (!submap.valid()) submap = main_submap(session_);  // nothing of this run was tracked
  result.trajectory = trajectory_in(session_, submap, first_frame_);
  result.frames_elsewhere = session_.frames.size() - first_frame_ - result.trajectory.size();
  result.keyframes = keyframes_in(session_, submap);
  result.loops = closed_loops_;
  std::vector<PosedView> posed;
  for (const ViewRecord& view : session_.views) {
    const FrameRecord& record = session_.frames[view.frame];
    if (submap_of(session_, record) != submap) continue;
    posed.push_back({T_world_frame(session_, record), view.view.get()});
  }
  result.map = static_map(posed, camera_, cloud_config_, threads_);
  return result;
}

PointCloud System::cloud_with_poses(
    std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const {
  const SubmapId submap = main_submap(session_, first_frame_);
  std::vector<std::optional<Eigen::Isometry3d>> poses(session_.frames.size());
  std::size_t given = 0;
  for (std::size_t i = first_frame_; i < poses.size(); ++i) {
    if (submap_of(session_, session_.frames[i]) != submap) continue;
    STILLMAP_CHECK(given < T_world_frames.size());
    poses[i] = T_world_frames[given++];
  }
  STILLMAP_CHECK(given == T_world_frames.size());
  std::vector<PosedView> posed;
  for (const ViewRecord& view : session_.views) {
    if (poses[view.frame]) posed.push_back({*poses[view.frame], view.view.get()});
  }
  return static_map(posed, camera_, cloud_config_, threads_);
}

}  // namespace stillmap
