// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/key_order.hpp"

#include <array>
#include <cstddef>

namespace stillmap {
namespace {

constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigits = 6;  // of 64 bits
constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
using Histogram = std::array<std::size_t, kBuckets>;

std::size_t digit(std::uint64_t key, std::size_t place) {
  return (key >> (place * kDigitBits)) & (kBuckets - 1);
}

std::array<Histogram, kDigits> count_digits(const std::vector<IndexedKey>& keys) {
  std::array<Histogram, kDigits> counts{};
  for (const IndexedKey& item : keys) {
    for (std::size_t place = 0; place < kDigits; ++place) ++counts[place][digit(item.key, place)];
  }
  return counts;
}

/// Replaces the count of each bucket by the position of its first element.
Histogram first_positions(const Histogram& counts) {
  Histogram first{};
  for (std::size_t i = 1; i < kBuckets; ++i) first[i] = first[i - 1] + counts[i - 1];
  return first;
}

}  // namespace

std::vector<IndexedKey> sorted_by_key(std::vector<IndexedKey> keys) {
  if (keys.empty()) return keys;
  const std::array<Histogram, kDigits> counts = count_digits(keys);
  std::vector<IndexedKey> sorted(keys.size());
  for (std::size_t place = 0; place < kDigits; ++place) {
    if (counts[place][digit(keys[0].key, place)] == keys.size())
      continue;  // all keys have this digit
    Histogram next = first_positions(counts[place]);
    for (const IndexedKey& item : keys) sorted[next[digit(item.key, place)]++] = item;
    keys.swap(sorted);
  }
  return keys;
}

}  // namespace stillmap
