// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "tooling/pipeline/run_observer.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Keeps the times of all frames and stages.
class TimingLog : public RunObserver {
 public:
  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_stage_time(std::string_view stage, double ms) override;

  /// Moves its data into the report. To be called once.
  void fill(RunReport& report);

 private:
  std::vector<double> frame_ms_;
  std::vector<StageTimes> stages_;  // in the order of their first work
};

}  // namespace stillmap
