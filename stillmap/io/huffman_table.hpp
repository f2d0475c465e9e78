// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace stillmap {

/// What a code of deflate (RFC 1951) stands for.
enum class HuffmanKind : std::uint8_t {
  kInvalid,
  kLiterals,  ///< one byte or two
  kBase,      ///< a length or distance, with extra bits to be added
  kEndOfBlock,
  kLongCode  ///< more bits than the first table looks at: go on in another
};

struct alignas(8) HuffmanEntry {  // for one load
  HuffmanKind kind = HuffmanKind::kInvalid;
  std::uint8_t bits = 0;    ///< to be consumed, all codes of the entry together
  std::uint8_t extra = 0;   ///< kBase: bits to add; kLiterals: how many; kLongCode: bits to look at
  std::uint16_t value = 0;  ///< literals, the first in the low byte; base; begin of the other table
};

/// A table over the next bits of a stream, the first bit lowest: kTableBits at first, then more for
/// longer codes.
class HuffmanTable {
 public:
  static constexpr unsigned kTableBits = 10;
  static constexpr unsigned kMaxCodeBits = 15;

  /// From the lengths of the codes (0: no such code, at most 15) and what each stands for, with
  /// `bits` of 0. False when the lengths make no prefix code, or one with gaps; a code of a single
  /// symbol may have them.
  [[nodiscard]] bool build(std::span<const std::uint8_t> lengths,
                           std::span<const HuffmanEntry> meanings);

  /// Makes entries of two literals where the bits hold both.
  void pair_literals();

  [[nodiscard]] const HuffmanEntry& first(std::uint64_t bits) const {
    return entries_[bits & ((1U << kTableBits) - 1)];
  }
  /// For an entry of kLongCode; `bits` as they were for first().
  [[nodiscard]] const HuffmanEntry& second(const HuffmanEntry& long_code,
                                           std::uint64_t bits) const {
    return entries_[long_code.value + ((bits >> kTableBits) & ((1U << long_code.extra) - 1))];
  }

 private:
  void add_code(std::uint32_t reversed, unsigned length, HuffmanEntry entry);

  std::vector<HuffmanEntry> entries_;
};

}  // namespace stillmap
