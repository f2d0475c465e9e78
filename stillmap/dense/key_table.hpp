// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace stillmap {

/// Numbers keys in the order in which they come: a hash table with open addressing.
class KeyTable {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  KeyTable();

  [[nodiscard]] std::size_t size() const { return keys_.size(); }

  /// The number of the key, or kNone.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const { return slots_[slot_of(key)]; }

  /// The number of the key; a new key gets the number size().
  [[nodiscard]] std::uint32_t find_or_add(std::uint64_t key);

 private:
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;
  void grow();

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> slots_;  ///< a number, or kNone; at most half are taken
};

}  // namespace stillmap
