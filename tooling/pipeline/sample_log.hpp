// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tooling/pipeline/run_observer.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Keeps some frames, spread evenly over the run, for the report to show.
class SampleLog : public RunObserver {
 public:
  /// `frames`: the number of frames of the run; if unknown, 8 to 15 frames are kept, else about 8.
  explicit SampleLog(std::optional<std::size_t> frames) : total_(frames) {}

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_damaged(const DamagedFrame&) override { ++frames_; }
  void on_dropped(std::size_t frames) override { frames_ += frames; }

  /// Moves the samples into the report. To be called once.
  void fill(RunReport& report);

 private:
  [[nodiscard]] bool wants_next();

  std::optional<std::size_t> total_;
  std::size_t frames_ = 0;  // so far
  std::size_t stride_ = 1;  // from one sample to the next, where the total is not known
  std::vector<ReportSample> samples_;
};

}  // namespace stillmap
