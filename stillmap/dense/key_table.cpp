// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/key_table.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kFirstSlots = 1024;

/// The finisher of splitmix64: every bit of the key changes about half of the bits.
std::uint64_t mix(std::uint64_t key) {
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9U;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebU;
  return key ^ (key >> 31U);
}

}  // namespace

KeyTable::KeyTable() : slots_(kFirstSlots, kNone) {}

std::uint32_t KeyTable::find_or_add(std::uint64_t key) {
  const std::size_t slot = slot_of(key);
  if (slots_[slot] != kNone) return slots_[slot];
  STILLMAP_CHECK(keys_.size() < kNone);
  const auto number = static_cast<std::uint32_t>(keys_.size());
  slots_[slot] = number;
  keys_.push_back(key);
  if (2 * keys_.size() > slots_.size()) grow();
  return number;
}

/// The slot of the key, or the empty slot where it belongs.
std::size_t KeyTable::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = mix(key) & mask;
  while (slots_[slot] != kNone && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
  return slot;
}

void KeyTable::grow() {
  const std::size_t mask = 2 * slots_.size() - 1;
  slots_.assign(mask + 1, kNone);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    std::size_t slot = mix(keys_[i]) & mask;
    while (slots_[slot] != kNone) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace stillmap
