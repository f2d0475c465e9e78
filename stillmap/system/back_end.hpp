// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "stillmap/concurrency/workers.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/loop/loop_stage.hpp"
#include "stillmap/system/dense_stage.hpp"
#include "stillmap/system/mapping_stage.hpp"
#include "stillmap/system/results.hpp"
#include "stillmap/system/smoothing_stage.hpp"

namespace stillmap {

/// Owns the map and everything that changes it after frames are tracked: mapping, loops, the views
/// of the dense map. Only the system's thread calls it. The frame at which a result is applied is
/// fixed when its job begins.
class BackEnd {
 public:
  /// The workers must be joined before this object is destroyed.
  BackEnd(const SystemConfig& config,
          const CameraModel& camera,
          const MeasurementModel& measure,
          Workers& workers,
          const StageProbe& probe);

  /// Continues a session. Only before the first frame. Throws Error when the session's views lack
  /// the free space that the settings ask for.
  void load(Session session);

  [[nodiscard]] const Map& map() const { return session_.map; }
  [[nodiscard]] const PlaceIndex& places() const { return loops_.places(); }
  /// The times of the camera, as learnt so far.
  [[nodiscard]] const CameraTimes& times() const { return times_.times(); }
  /// Loop corrections change T_world_camera; the odometry frame never jumps.
  [[nodiscard]] const Eigen::Isometry3d& T_odometry_world() const { return T_odometry_world_; }
  /// The camera's pose in a recorded frame, as the map has it now.
  [[nodiscard]] Eigen::Isometry3d T_world_camera(std::size_t record) const;

  /// Applies all results that are due: map updates, the loops that their key frames close,
  /// adjustments, and views.
  void apply_finished_work(std::int64_t frame_number);

  /// Counts how often each landmark was expected in a frame, and how often it was found.
  void count_landmarks(const TrackedFrame& tracked);
  /// Makes a key frame of a tracked frame and begins mapping around it.
  [[nodiscard]] KeyframeId insert_keyframe(const RgbdFrame& frame,
                                           const TrackedFrame& tracked,
                                           std::int64_t frame_number);
  /// Keeps a tracked frame's pose; returns its record. `tracked.reference` is a key frame.
  std::size_t record(const RgbdFrame& frame, const TrackedFrame& tracked);
  /// Tells the back end that a recorded frame has become a key frame later.
  void refer_to_keyframe(std::size_t record, KeyframeId keyframe);
  /// Begins a recorded frame's view of the dense map if a view is due at this frame.
  void add_view(const DenseStage::Candidate& candidate, std::int64_t frame_number) {
    dense_.add(candidate, frame_number);
  }
  /// Remembers the people in a frame, for the views of the frames near it.
  void remember_movers(double stamp_s, std::vector<MoverSighting> movers) {
    dense_.remember_movers(stamp_s, std::move(movers));
  }
  /// Whether a key frame is in the submap of a loaded session that has most of its frames.
  [[nodiscard]] bool is_in_loaded(KeyframeId keyframe) const;
  /// Tracking was lost.
  void lost() { loops_.tracking_lost(); }

  /// Waits for all pending work and adjusts the submap that has most of this run's frames.
  void finish();
  /// The objects known, in the world frame, of the odometry frame in it.
  using KnownObjects = std::function<std::vector<KnownObject>(const Eigen::Isometry3d&)>;
  /// Trajectory, key frames and map under the current poses.
  [[nodiscard]] RunResult result(const KnownObjects& known, std::size_t threads) const;
  /// The map that finish() and result() would give now. Changes nothing.
  [[nodiscard]] PointCloud map_snapshot(const KnownObjects& known, std::size_t threads) const;
  /// The map with the frames of the result's trajectory at other poses, in its order; frames
  /// without a pose add nothing to it.
  [[nodiscard]] PointCloud map_with_poses(
      std::span<const std::optional<Eigen::Isometry3d>> T_world_frames,
      const KnownObjects& known,
      std::size_t threads) const;

  /// The session to be saved, with the objects known. No other member may be called afterwards.
  [[nodiscard]] Session take_session(std::vector<KnownObject> objects);

 private:
  [[nodiscard]] BackEnd inline_copy() const;
  [[nodiscard]] SubmapId result_submap() const;
  [[nodiscard]] Eigen::Isometry3d T_world_last() const;
  void apply(const MappingResult& mapped, std::int64_t frame_number);
  void smooth_velocity(const Keyframe& keyframe);

  Session session_;
  std::size_t first_frame_ = 0;  // of this run in the session
  double delay_of_views_s_ = 0;  // what the times of this run's views have of depth's delay
  SubmapId next_submap_{0};
  SubmapId loaded_submap_;  // with most frames of the loaded session
  Eigen::Isometry3d T_odometry_world_ = Eigen::Isometry3d::Identity();
  std::vector<ClosedLoop> closed_loops_;

  CameraTimesEstimator times_;
  MappingStage mapping_;
  SmoothingStage smoothing_;
  CategoryTable categories_;
  DenseStage dense_;
  LoopStage loops_;
};

}  // namespace stillmap
