// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace stillmap {

/// The label with the most votes, in twelve bytes (Misra and Gries 1982, four counters).
///
/// Exact for up to four different labels: the label with the most votes wins, the smaller one of
/// equals. With more labels a label with more than half of all votes still wins; without such a
/// majority any frequent label may win. The sum of all weights must stay below 65536.
class LabelVote {
 public:
  static constexpr std::uint32_t kMostVotes = 65535;  ///< the greatest sum of weights

  void add(std::uint8_t label, std::uint16_t weight) {
    if (std::uint16_t* own = counter_of(label)) {
      *own = static_cast<std::uint16_t>(*own + weight);
      return;
    }
    // A fifth label: it and the four others cancel each other until one of the five has no votes.
    const std::uint16_t cancelled = std::min(*std::ranges::min_element(votes_), weight);
    for (std::uint16_t& votes : votes_) votes = static_cast<std::uint16_t>(votes - cancelled);
    if (weight > cancelled) {
      *counter_of(label) = static_cast<std::uint16_t>(weight - cancelled);
    }
  }

  /// The winning label; 0 without votes.
  [[nodiscard]] std::uint8_t winner() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < votes_.size(); ++i) {
      const bool tie = votes_[i] == votes_[best];
      if (tie ? labels_[i] < labels_[best] && votes_[i] > 0 : votes_[i] > votes_[best]) best = i;
    }
    return votes_[best] > 0 ? labels_[best] : std::uint8_t{0};
  }

 private:
  /// The counter of the label, else a free counter, which it takes; null when all four are taken.
  std::uint16_t* counter_of(std::uint8_t label) {
    std::uint16_t* free = nullptr;
    std::size_t free_index = 0;
    for (std::size_t i = 0; i < votes_.size(); ++i) {
      if (votes_[i] > 0 && labels_[i] == label) return &votes_[i];
      if (votes_[i] == 0 && free == nullptr) {
        free = &votes_[i];
        free_index = i;
      }
    }
    if (free != nullptr) labels_[free_index] = label;
    return free;
  }

  std::array<std::uint16_t, 4> votes_{};
  std::array<std::uint8_t, 4> labels_{};
};

}  // namespace stillmap
