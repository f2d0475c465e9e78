// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/progress_bar.hpp"
#include "tooling/pipeline/run_observer.hpp"

namespace stillmap {

/// Shows on the terminal how far a run is, and its warnings.
class RunProgress : public RunObserver {
 public:
  /// `frames`: how many there are; where that is not known, only warnings are shown. `objects` says
  /// what finds people and things.
  RunProgress(std::optional<std::size_t> frames, const std::string& objects)
      : total_(frames.value_or(0)) {
    bar_.say("objects     " + objects);
  }

  void on_frame(const RgbdFrame&, const FrameResult&) override { pass(1); }
  void on_damaged(const DamagedFrame&) override { pass(1); }
  void on_dropped(std::size_t frames) override { pass(frames); }
  void on_warning(const std::string& warning) override { bar_.warn(warning); }
  void on_end(const RunResult&) override { bar_.finish(); }

 private:
  void pass(std::size_t frames) {
    done_ += frames;
    bar_.show(done_, total_);
  }

  ProgressBar bar_{"frames"};
  std::size_t total_;
  std::size_t done_ = 0;
};

}  // namespace stillmap
