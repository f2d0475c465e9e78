// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/back_end.hpp"

#include <algorithm>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {
namespace {

constexpr double kAround_s = 0.07;  // frames so long before and after one tell its velocity
constexpr std::int64_t kEnd = std::int64_t{1} << 62;  // after all frames and their due results

CloudConfig resolved_cloud(const SystemConfig& config) {
  return config.cloud.resolved_for(dynamics_mode(config.dynamics.mode).cloud);
}

}  // namespace

BackEnd::BackEnd(const SystemConfig& config,
                 const CameraModel& camera,
                 const MeasurementModel& measure,
                 Workers& workers,
                 const StageProbe& probe)
    : session_{camera, {}, Map(measure.level_scales()), {}, {}, {}},
      times_(config.tracking.shutter, camera),
      mapping_(config.mapping, camera, measure, {workers.mapping(), probe}),
      smoothing_(config.tracking.smooth, {workers.dense(), probe}),
      categories_(config.dynamics.objects.categories),
      dense_(resolved_cloud(config), camera, {workers.dense(), probe}),
      loops_(config.loop,
             camera,
             loop_measurement_model(config, measure.level_scales()),
             config.seed,
             {workers.loops(), probe}) {}

void BackEnd::load(Session session) {
  const auto knows_free_space = [](const ViewRecord& v) { return !v.view->range.cells.empty(); };
  if (dense_.needs_free_space() && !std::ranges::all_of(session.views, knows_free_space)) {
    throw Error(
        "the saved map has views that know no free space, which these settings ask for: run with "
        "its own dynamics.mode, or with cloud.free_space=off");
  }
  session_ = std::move(session);
  first_frame_ = session_.frames.size();
  smoothing_.begin(first_frame_);
  loaded_submap_ = main_submap(session_);
  loops_.set_places(index_of(session_.map));
  const std::vector<SubmapId> submaps = session_.map.submaps();
  if (!submaps.empty()) next_submap_ = SubmapId(submaps.back().value + 1);
}

Eigen::Isometry3d BackEnd::T_world_camera(std::size_t record) const {
  return T_world_frame(session_, session_.frames[record]);
}

Eigen::Isometry3d BackEnd::T_world_last() const {
  return session_.frames.empty() ? Eigen::Isometry3d::Identity()
                                 : T_world_frame(session_, session_.frames.back());
}

// At most one key frame is mapped at a time, so that no mapping is under way when the map is moved.
void BackEnd::apply_finished_work(std::int64_t frame_number) {
  const Eigen::Isometry3d T_before = T_world_last();
  const std::size_t loops_before = closed_loops_.size();
  for (const MappingResult& m : mapping_.collect_due(frame_number)) apply(m, frame_number);
  bool moved = closed_loops_.size() > loops_before;
  if (mapping_.idle()) moved = loops_.apply_due(session_.map, frame_number) || moved;
  if (moved) T_odometry_world_ = T_odometry_world_ * T_before * T_world_last().inverse();
  dense_.collect_due(session_, T_odometry_world_, frame_number);
  smoothing_.process(session_, times(), frame_number);
}

void BackEnd::apply(const MappingResult& mapped, std::int64_t frame_number) {
  const MapUpdate& update = mapped.update;
  times_.add(mapped.times);
  Map& map = session_.map;
  map.apply(update);
  for (const auto& [dropped, anchor] : update.dropped_keyframes) loops_.remove_keyframe(dropped);
  if (!loops_.close(map, session_.loops, map.keyframes().rbegin()->first, frame_number)) return;
  const LoopEdge& loop = session_.loops.back();
  closed_loops_.push_back({map.keyframe(loop.a).stamp, map.keyframe(loop.b).stamp});
}

void BackEnd::count_landmarks(const TrackedFrame& tracked) {
  if (!has_pose(tracked)) return;
  for (const LandmarkId id : tracked.expected) session_.map.count_expected(id);
  for (const LandmarkId id : tracked.landmarks) {
    if (id.valid()) session_.map.count_found(id);
  }
}

bool BackEnd::is_in_loaded(KeyframeId keyframe) const {
  const Map& map = session_.map;
  return loaded_submap_.valid() &&
         map.keyframe(map.anchor(keyframe).keyframe).submap == loaded_submap_;
}

KeyframeId BackEnd::insert_keyframe(const RgbdFrame& frame,
                                    const TrackedFrame& tracked,
                                    std::int64_t frame_number) {
  Map& map = session_.map;
  if (!map.keyframes().empty()) smooth_velocity(map.keyframes().rbegin()->second);
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
  keyframe.timing = tracked.timing;
  keyframe.features = tracked.features;
  const KeyframeId id =
      mapping_.insert(map, std::move(keyframe), tracked.landmarks, times(), frame_number);
  loops_.add_keyframe(map.keyframe(id));
  return id;
}

// The velocity of a key frame is that since the frame before it. The frames after it are known now:
// that of all around it has a fifth of the noise.
void BackEnd::smooth_velocity(const Keyframe& keyframe) {
  const double stamp_s = keyframe.stamp.seconds;
  std::vector<TimedMotion> motions;
  for (std::size_t i = session_.frames.size(); i > 0; --i) {
    const FrameRecord frame = session_.frames[i - 1];
    const double after_s = frame.stamp.seconds - stamp_s;
    if (after_s < -kAround_s) break;
    if (after_s > kAround_s) continue;
    motions.push_back(
        {after_s, keyframe.T_world_camera.inverse() * T_world_frame(session_, frame)});
  }
  if (motions.size() < 2) return;
  FeatureTiming timing = keyframe.timing;
  timing.smooth_velocity = fitted_velocity(motions);
  session_.map.set_features(keyframe.id, keyframe.features, timing);
}

std::size_t BackEnd::record(const RgbdFrame& frame, const TrackedFrame& tracked) {
  const Eigen::Isometry3d T_reference_frame =
      session_.map.T_world_keyframe(tracked.reference).inverse() * tracked.T_world_camera;
  session_.frames.push_back({frame.stamp, tracked.reference, T_reference_frame});
  const Keyframe& reference =
      session_.map.keyframe(session_.map.anchor(tracked.reference).keyframe);
  smoothing_.add({tracked.information,
                  time_correction(tracked.timing, reference.timing, T_reference_frame.inverse())});
  return session_.frames.size() - 1;
}

void BackEnd::refer_to_keyframe(std::size_t record, KeyframeId keyframe) {
  session_.frames.set(record, {session_.frames[record].stamp, keyframe});
}

void BackEnd::finish() {
  apply_finished_work(kEnd);  // which may begin another adjustment
  loops_.finish(session_.map, main_submap(session_, first_frame_));
  smoothing_.finish(session_, times());
  const double delay_s = times().depth_delay_s;
  for (ViewRecord& view : session_.views) {
    if (view.frame >= first_frame_) view.depth_after_color_s += delay_s - delay_of_views_s_;
  }
  delay_of_views_s_ = delay_s;
}

// If this run tracked no frame, the result is the submap of the session that it continues.
SubmapId BackEnd::result_submap() const {
  const SubmapId submap = main_submap(session_, first_frame_);
  return submap.valid() ? submap : main_submap(session_);
}

RunResult BackEnd::result(const KnownObjects& known, std::size_t threads) const {
  RunResult result;
  const SubmapId submap = result_submap();
  result.trajectory = trajectory_in(session_, submap, first_frame_);
  result.frames_elsewhere = session_.frames.size() - first_frame_ - result.trajectory.size();
  result.keyframes = keyframes_in(session_, submap);
  result.loops = closed_loops_;
  MapWithoutVacated map =
      dense_.map_of(posed_views(session_, submap), known(T_odometry_world_), categories_, threads);
  result.map = std::move(map.points);
  result.vacated = std::move(map.vacated);
  return result;
}

BackEnd BackEnd::inline_copy() const {
  BackEnd copy = *this;
  copy.mapping_ = mapping_.inline_copy();
  copy.dense_ = dense_.inline_copy();
  copy.loops_ = loops_.inline_copy();
  copy.smoothing_ = smoothing_.inline_copy();
  return copy;
}

PointCloud BackEnd::map_snapshot(const KnownObjects& known, std::size_t threads) const {
  BackEnd copy = inline_copy();
  copy.finish();
  return copy.dense_
      .map_of(posed_views(copy.session_, copy.result_submap()),
              known(copy.T_odometry_world_),
              categories_,
              threads)
      .points;
}

PointCloud BackEnd::map_with_poses(std::span<const std::optional<Eigen::Isometry3d>> T_world_frames,
                                   const KnownObjects& known,
                                   std::size_t threads) const {
  const SubmapId submap = main_submap(session_, first_frame_);
  std::vector<std::optional<Eigen::Isometry3d>> poses(session_.frames.size());
  std::size_t given = 0;
  for (std::size_t i = first_frame_; i < poses.size(); ++i) {
    if (submap_of(session_, session_.frames[i]) != submap) continue;
    STILLMAP_CHECK(given < T_world_frames.size());
    poses[i] = T_world_frames[given++];
  }
  STILLMAP_CHECK(given == T_world_frames.size());
  const std::vector<PosedView> posed =
      posed_views(session_, [&](std::size_t i) { return poses[i]; });
  // Objects move with the first frame since they were last seen.
  std::vector<KnownObject> objects = known(T_odometry_world_);
  for (KnownObject& object : objects) {
    for (std::size_t i = first_frame_; i < poses.size(); ++i) {
      if (!poses[i] || session_.frames[i].stamp.seconds < object.seen_s) continue;
      object = moved(std::move(object), *poses[i] * T_world_camera(i).inverse());
      break;
    }
  }
  return dense_.map_of(posed, objects, categories_, threads).points;
}

Session BackEnd::take_session(std::vector<KnownObject> objects) {
  session_.objects = std::move(objects);
  session_.camera.readout_s = times().readout_s;
  return std::move(session_);
}

}  // namespace stillmap
