// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_gate.hpp"

#include <algorithm>

namespace stillmap {
namespace {

bool meet(const std::vector<KeyframeId>& a, const std::vector<KeyframeId>& b) {
  auto i = a.begin(), j = b.begin();
  while (i != a.end() && j != b.end()) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

}  // namespace

// The longest chain that the candidate continues, extended by it; else a new chain.
LoopGate::Chain LoopGate::extended(const GateCandidate& candidate) const {
  Chain result;
  result.group = candidate.neighbours;
  result.group.push_back(candidate.keyframe);
  std::ranges::sort(result.group);
  for (const Chain& chain : chains_) {
    if (meet(chain.group, result.group)) result.length = std::max(result.length, chain.length);
  }
  ++result.length;
  return result;
}

std::vector<KeyframeId> LoopGate::advance(std::span<const GateCandidate> candidates) {
  std::vector<KeyframeId> passed;
  std::vector<Chain> next;
  for (const GateCandidate& candidate : candidates) {
    next.push_back(extended(candidate));
    if (next.back().length >= config_.consecutive) passed.push_back(candidate.keyframe);
  }
  // A chain that no candidate continued is kept for a while.
  const std::size_t found = next.size();
  for (Chain& chain : chains_) {
    const bool continued = std::any_of(
        next.begin(), next.begin() + static_cast<std::ptrdiff_t>(found), [&](const Chain& other) {
          return meet(chain.group, other.group);
        });
    if (continued || ++chain.missed > config_.max_missed) continue;
    next.push_back(std::move(chain));
  }
  chains_ = std::move(next);
  return passed;
}

}  // namespace stillmap
