// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/timing_log.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace stillmap {

void TimingLog::on_frame(const RgbdFrame&, const FrameResult& result) {
  frame_ms_.push_back(result.pose_ms);
  for (const StageTime& time : result.stages) on_stage_time(time.stage, time.ms);
}

void TimingLog::on_stage_time(std::string_view stage, double ms) {
  const auto at = std::ranges::find(stages_, stage, &StageTimes::name);
  if (at != stages_.end()) {
    at->ms.push_back(ms);
  } else {
    stages_.push_back({std::string(stage), {ms}});
  }
}

void TimingLog::fill(RunReport& report) {
  report.frame_ms = std::move(frame_ms_);
  report.stages = std::move(stages_);
}

}  // namespace stillmap
