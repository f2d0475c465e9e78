// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/system.hpp"

namespace stillmap {

/// An image with what a network says of it and where it was truly taken.
struct TrialView {
  FramePtr frame;
  FrameDetections detections;
  Eigen::Isometry3d T_truth_camera = Eigen::Isometry3d::Identity();
};

/// What became of a frame that the system was shown.
struct TrialFrame {
  Stamp stamp;
  TrackingStatus status = TrackingStatus::kLost;
  int inliers = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> T_truth_camera;  ///< none: the camera was covered
};

/// What came of covering the camera once and showing it something else.
struct TrialOutcome {
  int invented = 0;    ///< frames of the covered camera that were given a pose
  int shown = 0;       ///< frames after it was uncovered
  int found_at = 0;    ///< the first of them with a pose, counted from 1; 0: none
  double error_m = 0;  ///< of that pose
  double error_deg = 0;
  double largest_error_m = 0;  ///< of it and those after it
  double largest_error_deg = 0;
  int tracked = 0;  ///< of the frames from then on: with a pose

  [[nodiscard]] bool right() const { return found_at > 0 && error_m < 0.05 && error_deg < 2.0; }
};

/// A system that is shown views in any order, as a camera at 30 Hz that is moved, covered and
/// uncovered. The network's objects are followed as in a run.
class RelocationTrial {
 public:
  RelocationTrial(const SystemConfig& config, const CameraModel& camera);

  void show(const TrialView& view);
  void cover(int frames);

  /// What became of all frames. Call once, at the end.
  [[nodiscard]] std::vector<TrialFrame> finish();

 private:
  void push(const RgbdFrame& picture,
            FrameDetections detections,
            const std::optional<Eigen::Isometry3d>& T_truth_camera);
  void process(FrameObjects objects);

  CameraModel camera_;
  std::unique_ptr<System> system_;  // stays where it is when a trial moves
  ObjectTracker objects_;
  std::vector<FramePtr> shown_;
  std::vector<TrialFrame> frames_;
  std::size_t processed_ = 0;
};

/// Of frames of which the camera is covered once, against the truth, in which the run's world lies
/// where the frames before put it. Throws Error when fewer than three of those have poses.
[[nodiscard]] TrialOutcome judge_trial(const std::vector<TrialFrame>& frames);

}  // namespace stillmap
