// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/system.hpp"

#include <algorithm>
#include <limits>

#include "stillmap/core/error.hpp"
#include "stillmap/mapping/map_adjustment.hpp"
#include "stillmap/system/label_image.hpp"
#include "stillmap/system/stopwatch.hpp"

namespace stillmap {
namespace {

const SystemConfig& checked(const SystemConfig& config) {
  config.check();
  return config;
}

constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();

}  // namespace

System::System(const SystemConfig& config, const CameraModel& camera, int threads)
    : config_(checked(config)),
      cloud_config_(config.cloud.decided(config.dynamics.mode)),
      camera_(camera),
      rays_(pixel_rays(camera)),
      dynamics_(config.dynamics, camera, config.seed),
      extractor_(config.tracking.orb, camera),
      measure_(config.measurement, extractor_.level_scales()),
      map_(extractor_.level_scales()),
      tracker_(config.tracking.tracker, config.relocalization, camera, measure_, config.seed),
      worker_(threads > 1 ? std::make_unique<Worker>() : nullptr),
      mapping_jobs_(worker_.get()),
      view_jobs_(worker_.get()) {}

FrameResult System::process(const FramePtr& frame, FrameObjects objects) {
  Stopwatch total, stage;
  FrameResult result;
  for (const MapUpdate& update : mapping_jobs_.collect_due(frame_number_)) apply(update);
  collect_views(frame_number_);
  result.stages.push_back({"mapping", stage.lap_ms()});

  const std::optional<Eigen::Isometry3d> expected =
      tracker_.expected_pose(frame->stamp.seconds, map_);
  if (dynamics_.enabled()) {
    result.dynamics = dynamics_.judge(*frame, std::move(objects), expected);
    result.stages.push_back({"dynamics", stage.lap_ms()});
  }
  Features features = extractor_.extract(frame->gray, frame->depth, result.dynamics.excluded);
  result.stages.push_back({"features", stage.lap_ms()});
  if (dynamics_.enabled()) {
    SiftedFeatures sifted = dynamics_.sift(*frame, std::move(features), result.dynamics, expected);
    features = std::move(sifted.features);
    result.dynamics.fates = std::move(sifted.fates);
    result.dynamics.dropped = std::move(sifted.dropped);
    result.stages.push_back({"feature sifting", stage.lap_ms()});
  }

  result.tracked = track(*frame, std::move(features));
  result.stages.push_back({"tracking", stage.lap_ms()});
  result.pose_ms = total.lap_ms();

  TrackedFrame& tracked = result.tracked;
  since_keyframe_.most_inliers = std::max(since_keyframe_.most_inliers, tracked.inliers);
  ++since_keyframe_.frames;
  if (tracked.status == TrackingStatus::kInitialized ||
      wants_keyframe(config_.keyframe, tracked, since_keyframe_)) {
    tracked.reference = insert_keyframe(*frame, tracked);
    result.is_keyframe = true;
  }
  ++since_view_;
  if (has_pose(tracked)) {
    record(*frame, tracked, tracked.T_world_camera);
    const int gap = config_.cloud.view_gap_frames;
    if (result.is_keyframe || (gap > 0 && since_view_ >= gap)) add_view(frame, result.dynamics);
  }
  if (dynamics_.enabled()) {
    has_pose(tracked) ? dynamics_.remember(*frame, tracked.T_world_camera, result.dynamics)
                      : dynamics_.forget();
  }
  result.stages.push_back({"keyframe", stage.lap_ms()});
  lost_ = !has_pose(tracked);
  ++frame_number_;
  return result;
}

TrackedFrame System::track(const RgbdFrame& frame, Features features) {
  if (map_.keyframes().empty()) {
    int with_depth = 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      with_depth += measure_.has_depth(features, i) ? 1 : 0;
    }
    if (with_depth >= config_.tracking.tracker.min_inliers) {
      return tracker_.start(frame, std::move(features));
    }
    TrackedFrame lost;
    lost.id = frame.id;
    lost.stamp_s = frame.stamp.seconds;
    lost.landmarks.assign(features.size(), LandmarkId{});
    lost.features = std::make_shared<const Features>(std::move(features));
    return lost;
  }
  TrackedFrame tracked = tracker_.track(frame, std::move(features), map_, places_);
  count_landmarks(tracked);
  return tracked;
}

void System::count_landmarks(const TrackedFrame& tracked) {
  if (!has_pose(tracked)) return;
  for (const LandmarkId id : tracked.expected) map_.count_expected(id);
  for (const LandmarkId id : tracked.landmarks) {
    if (id.valid()) map_.count_found(id);
  }
}

KeyframeId System::insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked) {
  Keyframe keyframe;
  keyframe.frame = frame.id;
  keyframe.stamp = frame.stamp;
  keyframe.T_world_camera = tracked.T_world_camera;
  keyframe.features = tracked.features;
  const KeyframeId id = map_.add_keyframe(std::move(keyframe));
  places_.add(id, tracked.features->descriptors);
  for (std::uint32_t i = 0; i < tracked.landmarks.size(); ++i) {
    if (!tracked.landmarks[i].valid()) continue;
    map_.add_observation(tracked.landmarks[i], {id, i});
    map_.refresh(tracked.landmarks[i]);
  }
  create_landmarks_from_depth(map_, id, camera_, measure_, config_.mapping.creation);
  (void)map_.take_changes();  // the owner knows them; only windows hand changes on
  tracker_.set_reference(id, map_);
  since_keyframe_ = {};

  std::vector<KeyframeId> core = mapping_core(map_, id, config_.mapping);
  auto window = std::make_shared<Map>(map_.window(core));
  mapping_jobs_.submit(
      frame_number_ + config_.mapping.lag_frames, [window, core = std::move(core), this] {
        return map_locally(std::move(*window), core, camera_, measure_, config_.mapping);
      });
  return id;
}

void System::apply(const MapUpdate& update) {
  map_.apply(update);
  for (const auto& [dropped, anchor] : update.dropped_keyframes) places_.remove(dropped);
}

// The last frame that was recorded.
void System::add_view(const FramePtr& frame, const FrameDynamics& dynamics) {
  const std::size_t index = views_.size();
  views_.push_back({static_cast<std::uint32_t>(records_.size() - 1), nullptr});
  since_view_ = 0;
  const DynamicMask mask = dynamics.judged.mask;
  const cv::Mat1b excluded = dynamics.excluded;
  const cv::Mat1b labels = label_image(frame->depth, dynamics);
  view_jobs_.submit(
      frame_number_ + config_.mapping.lag_frames, [frame, mask, excluded, labels, index, this] {
        const NotStatic masks = not_static(mask, excluded);
        return FinishedView(index,
                            std::make_shared<const StaticView>(
                                static_view(*frame, rays_, cloud_config_, masks, labels)));
      });
}

void System::collect_views(std::int64_t frame) {
  for (auto& [i, view] : view_jobs_.collect_due(frame)) views_[i].view = std::move(view);
}

void System::record(const RgbdFrame& frame,
                    const TrackedFrame& tracked,
                    const Eigen::Isometry3d& T_world_camera) {
  records_.push_back({frame.stamp,
                      tracked.reference,
                      map_.T_world_keyframe(tracked.reference).inverse() * T_world_camera});
}

RunResult System::finish() {
  for (const MapUpdate& update : mapping_jobs_.collect_due(kAll)) apply(update);
  collect_views(kAll);

  RunResult result;
  result.lost_at_end = lost_;
  result.trajectory = final_trajectory();
  for (const auto& [id, keyframe] : map_.keyframes()) {
    result.keyframes.push_back({keyframe.stamp, keyframe.T_world_camera});
  }
  std::vector<std::optional<Eigen::Isometry3d>> T_world_frames;
  for (const StampedPose& frame : result.trajectory) {
    T_world_frames.emplace_back(frame.T_world_camera);
  }
  result.map = cloud_with_poses(T_world_frames);
  return result;
}

Trajectory System::final_trajectory() const {
  Trajectory trajectory;
  trajectory.reserve(records_.size());
  for (const FrameRecord& record : records_) {
    trajectory.push_back({record.stamp, T_world_frame(record)});
  }
  return trajectory;
}

Eigen::Isometry3d System::T_world_frame(const FrameRecord& record) const {
  return map_.T_world_keyframe(record.reference) * record.T_reference_frame;
}

PointCloud System::cloud_with_poses(
    std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const {
  STILLMAP_CHECK(T_world_frames.size() == records_.size());
  std::vector<PosedView> posed;
  for (const ViewRecord& view : views_) {
    const std::optional<Eigen::Isometry3d>& T_world_frame = T_world_frames[view.frame];
    if (T_world_frame) posed.push_back({*T_world_frame, view.view.get()});
  }
  return static_map(posed, camera_, cloud_config_);
}

}  // namespace stillmap
