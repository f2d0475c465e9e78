// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tooling/pipeline/run_observer.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Keeps the outcome of each frame, and the warnings.
class FrameLog : public RunObserver {
 public:
  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_damaged(const DamagedFrame& frame) override;
  void on_dropped(std::size_t frames) override;
  void on_warning(const std::string& warning) override;

  /// The number of frames so far, of every kind.
  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] std::size_t damaged() const { return damaged_.size(); }

  /// Moves its data into the report. To be called once.
  void fill(RunReport& report);

 private:
  std::size_t frames_ = 0;
  std::vector<DamagedFrame> damaged_;
  std::vector<Stamp> lost_;
  std::map<std::string, std::size_t> matches_judged_by_;
  std::vector<int> tracked_features_;
  std::vector<std::string> warnings_;
};

}  // namespace stillmap
