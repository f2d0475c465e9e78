// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/io/scratch_records.hpp"
#include "tooling/pipeline/run_observer.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Keeps the times of all frames and stages, on the disk.
class TimingLog : public RunObserver {
 public:
  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_stage_time(std::string_view stage, double ms) override;

  /// Adds its data to the report.
  void fill(RunReport& report) const;

 private:
  void keep(std::size_t list, double ms);

  std::vector<std::string> stages_;  // in the order of their first work
  ScratchRecords times_;             // numbers of lists, and the times that are added to them
};

}  // namespace stillmap
