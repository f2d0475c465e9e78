// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/concurrency/worker.hpp"
#include "stillmap/dense/static_map.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// Makes the dense map's views: of key frames and of some frames between them.
class ViewStage {
 public:
  /// `config` is resolved. Views are in the session some frames after they were begun.
  ViewStage(const CloudConfig& config, const CameraModel& camera, const StageOptions& options);

  /// Views that have not been begun are dropped.
  ~ViewStage() { worker_.reset(); }
  ViewStage(const ViewStage&) = delete;
  ViewStage& operator=(const ViewStage&) = delete;

  /// A recorded frame with masks of its own.
  struct Candidate {
    const FramePtr& frame;
    const FrameDynamics& dynamics;
    std::size_t record;  ///< its place in the session's frames
    bool is_keyframe;
  };
  /// Makes its view if its turn has come. To be called in the order of the records.
  void add(const Candidate& candidate, std::int64_t frame_number);

  void collect_due(Session& session, std::int64_t frame_number);

 private:
  [[nodiscard]] bool is_due(std::int64_t record) const;
  [[nodiscard]] bool is_worth_keeping(const Session& session, const ViewRecord& made) const;

  CloudConfig config_;
  CameraModel camera_;
  cv::Mat2f rays_;
  std::optional<std::int64_t> last_;  // record of the last view's frame, at first that before all
  std::unique_ptr<Worker> worker_;
  JobLedger<ViewRecord> jobs_;
};

}  // namespace stillmap
