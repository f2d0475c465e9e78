// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace stillmap {

/// 256 binary intensity tests (rotated BRIEF).
using Descriptor = std::array<std::uint64_t, 4>;

inline constexpr int kDescriptorBits = 256;

/// The Hamming distance, 0 to 256.
[[nodiscard]] inline int hamming_distance(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

}  // namespace stillmap

/// Marks a function that compares many descriptors. The compiler makes two versions, with and
/// without the population count instruction, and the loader chooses. The results are the same
/// integers.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define STILLMAP_POPCOUNT_CLONES __attribute__((target_clones("popcnt", "default")))
#else
#define STILLMAP_POPCOUNT_CLONES
#endif
