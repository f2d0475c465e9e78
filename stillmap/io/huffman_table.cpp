// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/huffman_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace stillmap {
namespace {

constexpr unsigned kTableBits = HuffmanTable::kTableBits;
constexpr unsigned kMaxCodeBits = HuffmanTable::kMaxCodeBits;

std::uint32_t reversed(std::uint32_t code, unsigned length) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < length; ++bit) result |= ((code >> bit) & 1U) << (length - 1 - bit);
  return result;
}

}  // namespace

bool HuffmanTable::build(std::span<const std::uint8_t> lengths,
                         std::span<const HuffmanEntry> meanings) {
  std::array<std::uint32_t, kMaxCodeBits + 1> count{}, next{};
  for (const std::uint8_t length : lengths) ++count[length];
  const std::size_t symbols = lengths.size() - count[0];
  count[0] = 0;
  std::uint32_t code = 0;  // RFC 1951, 3.2.2
  for (unsigned length = 1; length <= kMaxCodeBits; ++length) {
    code = (code + count[length - 1]) << 1U;
    next[length] = code;
    if (code + count[length] > (1U << length)) return false;  // more codes than there are
  }
  const bool complete = code + count[kMaxCodeBits] == 1U << kMaxCodeBits;
  if (!complete && symbols > 1) return false;

  entries_.assign(std::size_t{1} << kTableBits, HuffmanEntry{});
  for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const unsigned length = lengths[symbol];
    if (length > 0) add_code(reversed(next[length]++, length), length, meanings[symbol]);
  }
  return true;
}

void HuffmanTable::add_code(std::uint32_t reversed, unsigned length, HuffmanEntry entry) {
  entry.bits = static_cast<std::uint8_t>(length);
  std::size_t begin = 0;
  unsigned table_bits = kTableBits;
  if (length > kTableBits) {
    // The tables of long codes all look at as many bits as there can be: they are few.
    const std::size_t at = reversed & ((1U << kTableBits) - 1);
    table_bits = kMaxCodeBits - kTableBits;
    if (entries_[at].kind != HuffmanKind::kLongCode) {
      entries_[at] = {HuffmanKind::kLongCode,
                      0,
                      static_cast<std::uint8_t>(table_bits),
                      static_cast<std::uint16_t>(entries_.size())};
      entries_.resize(entries_.size() + (std::size_t{1} << table_bits));
    }
    begin = entries_[at].value;
    reversed >>= kTableBits;
    length -= kTableBits;
  }
  for (std::size_t i = reversed; i < std::size_t{1} << table_bits; i += std::size_t{1} << length) {
    entries_[begin + i] = entry;
  }
}

void HuffmanTable::pair_literals() {
  // From the last down: what follows, with fewer bits, is still a single one then.
  for (std::size_t i = std::size_t{1} << kTableBits; i-- > 0;) {
    HuffmanEntry& entry = entries_[i];
    if (entry.kind != HuffmanKind::kLiterals) continue;
    const HuffmanEntry& second = entries_[i >> entry.bits];
    const bool fits = entry.bits + second.bits <= static_cast<int>(kTableBits);
    if (second.kind != HuffmanKind::kLiterals || !fits) continue;
    entry = {HuffmanKind::kLiterals,
             static_cast<std::uint8_t>(entry.bits + second.bits),
             2,
             static_cast<std::uint16_t>(entry.value | second.value << 8)};
  }
}

}  // namespace stillmap
