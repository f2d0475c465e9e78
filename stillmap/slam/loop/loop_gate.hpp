// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/ids.hpp"

namespace stillmap {

struct LoopGateConfig {
  int consecutive = 3;
  int max_missed = 1;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("consecutive",
          self.consecutive,
          FieldInfo{"key frames that must find one place before it counts", "key frames", 1, 100});
    visit("max_missed",
          self.max_missed,
          FieldInfo{"key frames between them that may find nothing", "key frames", 0, 100});
  }
};

/// A key frame that looks like the current one, with the key frames that share landmarks with it.
struct GateCandidate {
  KeyframeId keyframe;
  std::vector<KeyframeId> neighbours;  ///< in any order
};

/// Lets a candidate pass when key frames one after another have found the same place: a chain of
/// candidates each of which is, or shares landmarks with, the one before. One image that looks like
/// another by chance is no loop; some in a row that look like neighbours hardly are by chance.
///
/// A pure state machine over ids: time does not matter, nor the order of the candidates'
/// neighbours.
class LoopGate {
 public:
  explicit LoopGate(const LoopGateConfig& config) : config_(config) {}

  /// The candidates of the next key frame, best first, perhaps none; to be called for every key
  /// frame. Returns those whose place enough key frames in a row have found, in the same order.
  [[nodiscard]] std::vector<KeyframeId> advance(std::span<const GateCandidate> candidates);

  /// After a loop was closed, or tracking was lost: all begins anew.
  void clear() { chains_.clear(); }

 private:
  /// A place that was found by the last key frames.
  struct Chain {
    std::vector<KeyframeId> group;  // sorted: the last candidate and its neighbours
    int length = 0;                 // key frames that found it
    int missed = 0;                 // key frames since the last that did
  };

  [[nodiscard]] Chain extended(const GateCandidate& candidate) const;

  LoopGateConfig config_;
  std::vector<Chain> chains_;
};

}  // namespace stillmap
