// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/timing_log.hpp"

#include <algorithm>
#include <cstdint>

#include "stillmap/session/bytes.hpp"

namespace stillmap {

// List 0 has the times of frames, list 1 those of the first stage, and so on.
void TimingLog::keep(std::size_t list, double ms) {
  ByteWriter record;
  record.number(static_cast<std::uint32_t>(list));
  record.number(ms);
  times_.push_back(record.bytes());
}

void TimingLog::on_frame(const RgbdFrame&, const FrameResult& result) {
  keep(0, result.pose_ms);
  for (const StageTime& time : result.stages) on_stage_time(time.stage, time.ms);
}

void TimingLog::on_stage_time(std::string_view stage, double ms) {
  auto at = std::ranges::find(stages_, stage);
  if (at == stages_.end()) at = stages_.emplace(at, stage);
  keep(static_cast<std::size_t>(at - stages_.begin()) + 1, ms);
}

void TimingLog::fill(RunReport& report) const {
  for (const std::string& stage : stages_) report.stages.push_back({stage, {}});
  times_.visit([&](std::string_view bytes) {
    ByteReader record(std::string(bytes), "the times of a run");
    const auto list = record.number<std::uint32_t>();
    std::vector<double>& ms = list == 0 ? report.frame_ms : report.stages.at(list - 1).ms;
    ms.push_back(record.number<double>());
  });
}

}  // namespace stillmap
