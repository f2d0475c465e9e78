// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace stillmap {

/// Parts of a run that may work beside each other.
enum class Stage { kReading, kPreparation, kTracking, kMapping, kViews, kAdjustment };

/// Called whenever a stage begins a piece of work, on the thread that does it: so tests make stages
/// slow, or fail with what it throws. Empty otherwise. Called by several threads at once.
using StageProbe = std::function<void(Stage)>;

inline void begin_work(const StageProbe& probe, Stage stage) {
  if (probe) probe(stage);
}

/// How a stage does its work.
struct StageOptions {
  bool threaded = false;  ///< on a thread of its own
  StageProbe probe = {};
};

}  // namespace stillmap
