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
  /// `config` is decided. `threaded`: views are made on a thread of their own. They are in the
  /// session some frames later.
  ViewStage(const CloudConfig& config, const CameraModel& camera, bool threaded);

  /// Views that have not been begun are dropped.
  ~ViewStage() { worker_.reset(); }
  ViewStage(const ViewStage&) = delete;
  ViewStage& operator=(const ViewStage&) = delete;

  /// Of the frame whose record is the session's last, if its turn has come. To be called for each
  /// recorded frame.
  void add(Session& session,
           const FramePtr& frame,
           const FrameDynamics& dynamics,
           bool is_keyframe,
           std::int64_t frame_number);

  void collect_due(Session& session, std::int64_t frame_number);

 private:
  using FinishedView = std::pair<std::size_t, std::shared_ptr<const StaticView>>;

  CloudConfig config_;
  cv::Mat2f rays_;
  int since_last_ = 0;  // frames
  std::unique_ptr<Worker> worker_;
  JobLedger<FinishedView> jobs_;
};

}  // namespace stillmap
