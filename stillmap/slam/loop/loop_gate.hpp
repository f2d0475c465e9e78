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
          FieldInfo{
              "number of consecutive key frames that must find one place", "key frames", 1, 100});
    visit("max_missed",
          self.max_missed,
          FieldInfo{"number of key frames in between that may miss it", "key frames", 0, 100});
  }
};

/// A key frame that looks like the current one, with its covisible key frames.
struct GateCandidate {
  KeyframeId keyframe;
  std::vector<KeyframeId> neighbours;  ///< in any order
};

/// Passes a candidate when consecutive key frames have found the same place: a chain of candidates
/// each of which is, or is covisible with, the one before. A single image may look like another by
/// chance; several in a row hardly look like neighbours by chance.
///
/// A state machine over ids that depends neither on time nor on the order of neighbours.
class LoopGate {
 public:
  explicit LoopGate(const LoopGateConfig& config) : config_(config) {}

  /// Takes the candidates of the next key frame, best first, possibly none; to be called for every
  /// key frame. Returns those whose place enough consecutive key frames have found, in the same
  /// order.
  [[nodiscard]] std::vector<KeyframeId> advance(std::span<const GateCandidate> candidates);

  /// Starts again. To be called after a loop was closed, and when tracking was lost.
  void clear() { chains_.clear(); }

 private:
  /// A place that recent key frames found.
  struct Chain {
    std::vector<KeyframeId> group;  // sorted: the last candidate and its neighbours
    int length = 0;                 // number of key frames that found it
    int missed = 0;                 // number of key frames since the last that found it
  };

  [[nodiscard]] Chain extended(const GateCandidate& candidate) const;

  LoopGateConfig config_;
  std::vector<Chain> chains_;
};

}  // namespace stillmap
