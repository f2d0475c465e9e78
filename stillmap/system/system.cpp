// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/system.hpp"

#include <algorithm>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/stage_clock.hpp"
#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/system/stages.hpp"

namespace stillmap {

System::System(const Settings& settings, const CameraModel& camera, const SystemOptions& options)
    : stages_(std::make_unique<Stages>(settings.config(), camera, options)) {}

System::~System() = default;

PreparedFrame System::prepare(FramePtr frame, FrameObjects objects) const {
  return stages_->prepare(std::move(frame), std::move(objects));
}

FrameResult System::process(const RgbdFrame& frame, FrameObjects objects) {
  const auto copy = std::make_shared<RgbdFrame>(frame);  // copies image handles, no pixels
  if (!copy->id.valid()) copy->id = FrameId(static_cast<std::uint32_t>(stages_->frame_number));
  return process(copy, std::move(objects));
}

FrameResult System::process(const FramePtr& frame, FrameObjects objects, MaskOrigin origin) {
  return process(prepare(frame, std::move(objects)), origin);
}

FrameResult System::process(PreparedFrame prepared, MaskOrigin origin) {
  Stages& s = *stages_;
  StageClock clock;
  const RgbdFrame& frame = *prepared.frame;
  clock.time("mapping", [&] { s.apply_finished_work(); });
  const std::optional<Eigen::Isometry3d> expected = s.expected_pose(frame);
  const FrameDynamics dynamics = clock.time("dynamics", prepared.objects_ms, [&] {
    return s.dynamics->judge(frame, std::move(prepared.objects), prepared.measured, expected);
  });
  Features extracted = clock.time("features", prepared.corners_ms, [&] {
    return s.extractor.extract(prepared.corners, frame.depth, dynamics.unsearched);
  });
  FilteredFeatures features = clock.time("feature filter", [&] {
    return s.dynamics->filter(frame, std::move(extracted), dynamics, expected);
  });
  TrackedFrame tracked = clock.time("tracking", [&] {
    return s.track(prepared, std::move(features.features), dynamics, origin);
  });
  const bool is_keyframe =
      clock.time("keyframe", [&] { return s.insert_if_keyframe(frame, tracked, origin); });
  FrameResult result =
      s.remember({prepared.frame, dynamics, tracked, features, origin, is_keyframe});
  result.pose_ms = clock.total_ms("tracking");
  result.stages = clock.take();
  s.notify(frame, result);
  return result;
}

void System::take_objects(FrameObjects objects) {
  stages_->take_objects(std::move(objects));
}

bool System::needs_own_objects() const {
  return stages_->needs_own_objects();
}

PointCloud System::map_snapshot() const {
  return stages_->map_snapshot();
}

RunResult System::finish() {
  Stages& s = *stages_;
  s.back_end.finish();
  RunResult result = s.back_end.result(s.known_objects(), s.threads);
  result.lost_at_end = s.lost_frames > 0 || s.frame_number == 0;
  result.united_tracks = s.dynamics->united_tracks();
  for (Observer* observer : s.observers) {
    observer->on_map(result.map, s.frame_number);
    observer->on_end(result);
  }
  return result;
}

PointCloud System::map_with_poses(
    std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const {
  return stages_->back_end.map_with_poses(
      T_world_frames, stages_->known_objects(), stages_->threads);
}

void System::load(Session session) {
  Stages& s = *stages_;
  STILLMAP_CHECK(s.frame_number == 0);
  check_fits(session, s.camera, s.extractor.level_scales(), "the saved map");
  s.dynamics->know_objects(std::move(session.objects));
  s.back_end.load(std::move(session));
}

Session System::take_session() {
  BackEnd& back_end = stages_->back_end;
  return back_end.take_session(stages_->dynamics->known_objects(back_end.T_odometry_world()));
}

const Map& System::map() const {
  return stages_->back_end.map();
}

double System::readout_s() const {
  return stages_->back_end.times().readout_s;
}

double System::depth_delay_s() const {
  return stages_->back_end.times().depth_delay_s;
}

}  // namespace stillmap
