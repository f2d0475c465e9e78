// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/worker.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/loop/loop_stage.hpp"
#include "stillmap/system/frame_result.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/view_stage.hpp"

namespace stillmap {

/// A place that was recognised: the stamps of the key frames that saw it.
struct ClosedLoop {
  Stamp earlier, later;
};

/// All that a finished run knows, under final poses.
struct RunResult {
  /// The run's tracked frames in the submap that has most of them. Others were tracked after a loss
  /// in a submap of their own, which no known place has joined to this one.
  Trajectory trajectory;
  std::size_t frames_elsewhere = 0;  ///< tracked, but in such a submap
  Trajectory keyframes;              ///< of that submap, also those of a session that it continues
  PointCloud map;                    ///< of that submap
  std::vector<ClosedLoop> loops;     ///< closed in this run
  bool lost_at_end = false;
};

struct SystemOptions {
  int threads = 1;  ///< 2 or more: mapping, clouds and loops beside the caller; the end on so many
  bool localize_only = false;  ///< the map stays as it is
  StageProbe probe = {};       ///< of tests
};

/// The SLAM system: owns the map and every stage.
///
/// Frames go in one after another, in the order of their stamps; each comes back with its pose. The
/// caller may be a plain loop: with `threads` 1 everything runs inside process(), with 2 or more
/// mapping and clouds run beside it, and the results are the same bits.
class System {
 public:
  /// Throws Error for settings that contradict each other.
  System(const SystemConfig& config, const CameraModel& camera, const SystemOptions& options);

  /// Jobs that have not begun are dropped; one that runs is waited for, as it uses what is here.
  ~System() { worker_.reset(); }
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Goes on from a saved session, once the camera sees a place that it knows. Before the first
  /// frame. Throws Error when the session is of another camera or of another image pyramid.
  void load(Session session);

  /// The part of process() that needs nothing of other frames. May be called on any thread while
  /// others are being processed. `objects`: what a network has found in it, if there is one.
  [[nodiscard]] PreparedFrame prepare(const RgbdFrame& frame, const FrameObjects& objects) const;

  /// Tracks a frame. Frames have the camera's size. `prepared`: what prepare() says of the same.
  /// Only with objects of its own may it become a key frame, begin a map or be seen in the cloud.
  FrameResult process(const FramePtr& frame,
                      FrameObjects objects,
                      PreparedFrame prepared,
                      MaskOrigin origin = MaskOrigin::kOwn);

  /// Both at once.
  FrameResult process(const FramePtr& frame,
                      FrameObjects objects = {},
                      MaskOrigin origin = MaskOrigin::kOwn);

  /// The own objects of a frame that was processed while they were awaited, in the order of those
  /// frames, and before the next is processed: it may become a key frame now, with the features off
  /// its own masks, and be seen in the cloud. Nothing happens when it had no pose, or when one
  /// after it was given before.
  void take_objects(FrameObjects objects);

  /// Nothing to track in: the next frame needs objects of its own, as it may begin a map.
  [[nodiscard]] bool needs_own_objects() const;

  /// Ends the run: waits for pending work and assembles the cloud. Call once.
  [[nodiscard]] RunResult finish();

  /// The cloud as it would be with the frames at other poses, in the order of
  /// RunResult::trajectory; frames without a pose add nothing to it, nor do those that are not
  /// in there. After finish().
  [[nodiscard]] PointCloud cloud_with_poses(
      std::span<const std::optional<Eigen::Isometry3d>> T_world_frames) const;

  /// What can be saved. After finish(); nothing else may be asked then.
  [[nodiscard]] Session take_session() { return std::move(session_); }
  [[nodiscard]] const Map& map() const { return session_.map; }
  /// Readout time of the camera's rolling shutter, as learnt so far.
  [[nodiscard]] double readout_s() const { return tracker_.readout_s(); }

 private:
  /// A tracked frame whose own objects are looked for.
  struct AwaitingObjects {
    FramePtr frame;
    TrackedFrame tracked;
    std::size_t record;  // in session_.frames
  };

  [[nodiscard]] bool may_begin_submap(const Features& features) const;
  [[nodiscard]] TrackedFrame track(const RgbdFrame& frame, Features features, MaskOrigin origin);
  [[nodiscard]] KeyframeId insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked);
  [[nodiscard]] TrackedFrame without_masked_features(const AwaitingObjects& awaiting,
                                                     const cv::Mat1b& excluded) const;
  void remember(const FramePtr& frame, FrameResult& result, MaskOrigin origin);
  void count_landmarks(const TrackedFrame& tracked);
  void update_map(std::int64_t frame);
  void apply(const MapUpdate& update);

  SystemConfig config_;
  CloudConfig cloud_config_;  // resolved
  CameraModel camera_;
  std::size_t threads_;
  bool localize_only_;
  StageProbe probe_;
  DynamicsStage dynamics_;
  OrbExtractor extractor_;
  MeasurementModel measure_;
  Session session_;
  std::size_t first_frame_ = 0;  // of this run in the session
  Tracker tracker_;

  std::int64_t frame_number_ = 0;  // of those processed
  std::deque<AwaitingObjects> awaiting_;
  KeyframeAge since_keyframe_;
  std::vector<ClosedLoop> closed_loops_;
  int lost_frames_ = 0;  // in a row
  SubmapId next_submap_{0};
  /// Corrections move the submap; what compares frames with their past goes on in coordinates that
  /// stay.
  Eigen::Isometry3d T_odometry_world_ = Eigen::Isometry3d::Identity();

  std::unique_ptr<Worker> worker_;
  JobLedger<MapUpdate> mapping_jobs_;
  ViewStage views_;
  LoopStage loops_;
};

}  // namespace stillmap
