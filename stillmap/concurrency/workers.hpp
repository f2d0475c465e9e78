// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/concurrency/worker.hpp"

namespace stillmap {

/// The only owner of the threads of a system's stages. Without threads every pointer is null and
/// jobs run inline.
class Workers {
 public:
  explicit Workers(bool threaded) {
    if (!threaded) return;
    mapping_.emplace();
    loops_.emplace();
    dense_.emplace(Worker::Priority::kLow);
  }

  [[nodiscard]] Worker* mapping() { return pointer(mapping_); }
  [[nodiscard]] Worker* loops() { return pointer(loops_); }
  [[nodiscard]] Worker* dense() { return pointer(dense_); }

  /// Drops the jobs that have not begun and waits for those that run. To be called before the
  /// stages to which jobs refer are destroyed.
  void join() {
    mapping_.reset();
    dense_.reset();
    loops_.reset();
  }

 private:
  static Worker* pointer(std::optional<Worker>& worker) { return worker ? &*worker : nullptr; }

  std::optional<Worker> mapping_, loops_, dense_;
};

}  // namespace stillmap
