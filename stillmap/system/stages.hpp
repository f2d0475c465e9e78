// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "stillmap/concurrency/workers.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"
#include "stillmap/slam/tracking/keyframe_policy.hpp"
#include "stillmap/slam/tracking/tracker.hpp"
#include "stillmap/system/back_end.hpp"
#include "stillmap/system/late_objects.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/system.hpp"

namespace stillmap {

/// The stages of a System and the state between frames. System::process() determines their order;
/// this struct, what each stage does to the state.
struct System::Stages {
  Stages(const SystemConfig& config, const CameraModel& camera, const SystemOptions& options);
  ~Stages() { workers.join(); }
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  /// A tracked frame with everything that is to be remembered of it.
  struct Outcome {
    const FramePtr& frame;
    const FrameDynamics& dynamics;
    const TrackedFrame& tracked;
    const FilteredFeatures& features;
    MaskOrigin origin;
    bool is_keyframe;
  };

  [[nodiscard]] PreparedFrame prepare(FramePtr frame, FrameObjects objects) const;
  void apply_finished_work();
  /// The predicted pose in the odometry frame; nothing while lost and before the first frame.
  [[nodiscard]] std::optional<Eigen::Isometry3d> expected_pose(const RgbdFrame& frame) const;
  /// The frame's pose by its features and, where these are too few, by doubted ones on dynamic
  /// objects.
  [[nodiscard]] TrackedFrame track(const PreparedFrame& prepared,
                                   Features features,
                                   const FrameDynamics& judged,
                                   MaskOrigin origin);
  /// Makes a key frame of the frame where the policy wants one; it then is its own reference.
  bool insert_if_keyframe(const RgbdFrame& frame, TrackedFrame& tracked, MaskOrigin origin);
  /// Records the frame and passes it to dynamics, dense map and late objects.
  [[nodiscard]] FrameResult remember(const Outcome& outcome);
  void notify(const RgbdFrame& frame, const FrameResult& result);
  void take_objects(FrameObjects objects);
  [[nodiscard]] bool needs_own_objects() const;
  [[nodiscard]] BackEnd::KnownObjects known_objects() const;
  /// The map that the run would have if it ended now.
  [[nodiscard]] PointCloud map_snapshot() const;

  SystemConfig config;
  CameraModel camera;
  std::size_t threads;
  bool localize_only;
  StageProbe probe;
  std::vector<Observer*> observers;
  std::int64_t snapshot_every_frames;

  Workers workers;
  std::unique_ptr<DynamicsStage> dynamics;
  OrbExtractor extractor;
  MeasurementModel measure;
  Tracker tracker;
  BackEnd back_end;
  LateObjects late_objects;

  std::int64_t frame_number = 0;  // of processed frames
  KeyframeAge since_keyframe;
  int lost_frames = 0;  // in a row

 private:
  [[nodiscard]] int count_with_depth(const Features& features) const;
  /// `own`, or also doubted ones where these are few: rather standing ones, all where even these do
  /// not suffice.
  [[nodiscard]] FeaturesPtr features_to_begin(FeaturesPtr own, const MoreFeatures& more) const;
  [[nodiscard]] std::optional<Features> with_doubted(const PreparedFrame& prepared,
                                                     const Features& features,
                                                     const FrameDynamics& judged) const;
  [[nodiscard]] KeyframeId insert_keyframe(const RgbdFrame& frame, const TrackedFrame& tracked);
};

}  // namespace stillmap
