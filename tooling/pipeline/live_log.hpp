// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/io/scratch_records.hpp"
#include "tooling/pipeline/live_record.hpp"

namespace stillmap {

/// Keeps the decisions of the clock in a live run, on the disk.
class LiveLog {
 public:
  void push_back(const LiveStep& step);
  /// All of them, in order.
  [[nodiscard]] LiveRecord record() const;

 private:
  ScratchRecords steps_;
};

}  // namespace stillmap
