// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/slam/optim/time_correction.hpp"

namespace stillmap {

/// What is known of a recorded pose besides the pose.
struct PoseEvidence {
  /// Of a step of T_camera_world by perturb_left(), as far as its features' errors are independent.
  Matrix6d information = Matrix6d::Zero();
  TimeCorrection time_correction;  ///< of its pose relative to its reference
};

/// Smooths the trajectory of a run's frames, in each submap for itself (smooth_trajectory()).
///
/// Poses measured before the camera's times were known are corrected for the times as known now.
///
/// The last poses, `most` of them at least, are smoothed at the end, under the final map. Earlier
/// ones are smoothed while the run goes on, a thousand at a time, under the map of that time,
/// because their information cannot be kept for ever; later corrections of the map move them as
/// they are. A shorter run is thus smoothed as a whole.
class SmoothingStage {
 public:
  static constexpr std::size_t kMost = 10000;

  /// `smooths`: otherwise poses stay as they were measured.
  SmoothingStage(bool smooths, const StageOptions& options, std::size_t most = kMost);
  /// A stage with the same pending work, whose own work runs inline.
  [[nodiscard]] SmoothingStage inline_copy() const;

  /// The run's frames are those from this record on. Only before the first add().
  void begin(std::size_t first_record) { first_record_ = first_record; }
  /// Adds what is known of the next recorded pose.
  void add(const PoseEvidence& frame);
  /// Takes over what is due, and begins to smooth the earliest poses where too many wait.
  void process(Session& session, const CameraTimes& times, std::int64_t frame_number);
  /// Takes over all work, and smooths all poses that wait.
  void finish(Session& session, const CameraTimes& times);
  /// The number of poses that wait.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  /// What smoothing does to a recorded pose, in the coordinates of its camera.
  struct Correction {
    std::size_t record;
    Eigen::Isometry3d T_before_after;
  };
  using Corrections = std::vector<Correction>;
  void take_over(Session& session, std::int64_t frame_number);

  bool smooths_;
  std::size_t most_;
  std::size_t first_record_ = 0;  // that waits
  std::deque<PoseEvidence> waiting_;
  JobLedger<Corrections> jobs_;
};

}  // namespace stillmap
