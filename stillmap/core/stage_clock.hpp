// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "stillmap/core/status.hpp"
#include "stillmap/core/stopwatch.hpp"

namespace stillmap {

/// Measures the wall-clock times of the stages of one frame. For reports only: no result depends on
/// them.
class StageClock {
 public:
  /// Runs a stage and returns its result. `before_ms`, the time of the part that was done ahead, is
  /// added to its time.
  template <class Work>
  decltype(auto) time(std::string_view stage, double before_ms, const Work& work) {
    const Scope scope{*this, stage, before_ms};
    return work();
  }
  template <class Work>
  decltype(auto) time(std::string_view stage, const Work& work) {
    return time(stage, 0.0, work);
  }

  /// The time of all stages up to that one, included.
  [[nodiscard]] double total_ms(std::string_view last_stage) const {
    double sum = 0;
    for (const StageTime& time : times_) {
      sum += time.ms;
      if (time.stage == last_stage) break;
    }
    return sum;
  }
  [[nodiscard]] std::vector<StageTime> take() { return std::move(times_); }

 private:
  struct Scope {
    StageClock& clock;
    std::string_view stage;
    double before_ms;
    Stopwatch watch = {};
    ~Scope() { clock.times_.push_back({stage, before_ms + watch.lap_ms()}); }
  };

  std::vector<StageTime> times_;
};

}  // namespace stillmap
