// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "stillmap/session/session.hpp"
#include "stillmap/system/cloud_stage.hpp"
#include "stillmap/system/job_ledger.hpp"
#include "stillmap/system/worker.hpp"

namespace stillmap {

/// Makes the dense map's views: of key frames and of some frames between them.
class ViewStage {
 public:
  /// `config` is decided. Views are made by the worker (inline without one) and are in the session
  /// `lag_frames` later.
  ViewStage(const CloudConfig& config, const CameraModel& camera, int lag_frames, Worker* worker);

  /// Of the frame whose record is the session's last, if its turn has come. To be called for each
  /// recorded frame.
  void add(Session& session,
           const FramePtr& frame,
           const FrameDynamics& dynamics,
           bool is_keyframe,
           std::int64_t frame_number);

  void collect_due(Session& session, std::int64_t frame_number);

 private:
  [[nodiscard]] bool is_news(const Session& session, const ViewRecord& made) const;

  CloudConfig config_;
  CameraModel camera_;
  cv::Mat2f rays_;
  int lag_frames_;
  int since_last_ = 0;  // frames
  JobLedger<ViewRecord> jobs_;
};

}  // namespace stillmap
