// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace stillmap {

/// The stages of a run that may work at the same time.
enum class Stage { kReading, kPreparation, kTracking, kMapping, kViews, kAdjustment };

/// A function called at the beginning of each piece of a stage's work, on the thread that does the
/// work. Tests use it to slow a stage down or, by throwing, to make it fail; otherwise it is empty.
/// Several threads may call it at the same time.
using StageProbe = std::function<void(Stage)>;

inline void begin_work(const StageProbe& probe, Stage stage) {
  if (probe) probe(stage);
}

class Worker;

/// Where and how observed a stage does its work.
struct StageOptions {
  Worker* worker = nullptr;  ///< not owned; null: jobs run inline
  StageProbe probe = {};
};

}  // namespace stillmap
