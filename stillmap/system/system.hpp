// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/map/map.hpp"
#include "stillmap/place/place_index.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/system/cloud_stage.hpp"
#include "stillmap/system/config.hpp"
#include "stillmap/system/dynamics_stage.hpp"
#include "stillmap/system/frame_result.hpp"
#include "stillmap/system/job_ledger.hpp"
#include "stillmap/system/worker.hpp"

namespace stillmap {

/// All that a finished run knows, under final poses.
struct RunResult {
  Trajectory trajectory;  ///< frames that were tracked
  Trajectory keyframes;
  PointCloud map;
  bool lost_at_end = false;
};

/// The SLAM system: owns the map and every stage.
///
/// Frames go in one after another, in the order of their stamps; each comes back with its pose. The
/// caller may be a plain loop: with `threads` 1 everything runs inside process(), with 2 or more
/// mapping and clouds run beside it, and the results are the same bits.
class System {
 public:
  /// Throws Error for settings that contradict each other.
  System(const SystemConfig& config, const CameraModel& camera, int threads);

  /// Tracks a frame; it may become a key frame. Frames have the camera's size. `objects`: what a
  /// network has found in it, if there is one.
  FrameResult process(const FramePtr& frame, FrameObjects objects = {});

  /// Ends the run: waits for pending work and assembles the cloud. Call once.
  [[nodiscard]] RunResult finish();

  /// The cloud as it would be with the frames at other poses, in the order of
  /// RunResult::trajectory; frames without a pose add nothing to it. After finish().
  [[nodiscard]] PointCloud cloud_with_poses(
      std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const;

  [[nodiscard]] const Map& map() const { return map_; }
  /// Readout time of the camera's rolling shutter, as learnt so far.
  [[nodiscard]] double readout_s() const { return tracker_.readout_s(); }

 private:
  using FinishedView = std::pair<std::size_t, std::shared_ptr<const StaticView>>;

  [[nodiscard]] TrackedFrame track(const RgbdFrame& frame, Features features);
  [[nodiscard]] KeyframeId insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked);
  void apply(const MapUpdate& update);
  void add_view(const FramePtr& frame, const FrameDynamics& dynamics);
  [[nodiscard]] Eigen::Isometry3d T_world_frame(const FrameRecord& record) const;
  void count_landmarks(const TrackedFrame& tracked);
  void collect_views(std::int64_t frame);
  void record(const RgbdFrame& frame,
              const TrackedFrame& tracked,
              const Eigen::Isometry3d& T_world_camera);
  [[nodiscard]] Trajectory final_trajectory() const;

  SystemConfig config_;
  CloudConfig cloud_config_;  // decided
  CameraModel camera_;
  cv::Mat2f rays_;
  DynamicsStage dynamics_;
  OrbExtractor extractor_;
  MeasurementModel measure_;
  Map map_;
  PlaceIndex places_;  // of its key frames
  Tracker tracker_;

  std::int64_t frame_number_ = 0;  // of those processed
  KeyframeAge since_keyframe_;
  bool lost_ = true;  // until the first frame
  std::vector<FrameRecord> records_;
  std::vector<ViewRecord> views_;  // of what goes into the map
  int since_view_ = 0;             // frames

  std::unique_ptr<Worker> worker_;
  JobLedger<MapUpdate> mapping_jobs_;
  JobLedger<FinishedView> view_jobs_;
};

}  // namespace stillmap
