// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace stillmap {

/// Scrambles 64 bits so that counters become independent-looking numbers (a bijection).
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// A normally distributed number (mean 0, sigma 1) that is a function of `key` alone: the sum of
/// four uniforms, so never beyond 3.47 sigma. Needs no state, hence no order of evaluation.
[[nodiscard]] constexpr float hash_normal(std::uint64_t key) {
  const std::uint64_t bits = mix_bits(key);
  float sum = 0.F;
  for (unsigned part = 0; part < 4; ++part) {
    sum += static_cast<float>((bits >> (16U * part)) & 0xffffU);
  }
  constexpr float kMean = 2.F * 65535.F;
  constexpr float kInverseSigma = 1.7320508F / 65536.F;  // variance of the sum: 4 * 65536^2 / 12
  return (sum - kMean) * kInverseSigma;
}

/// A uniform number in [0, 1) that is a function of `key` alone.
[[nodiscard]] constexpr float hash_uniform(std::uint64_t key) {
  return static_cast<float>(mix_bits(key) >> 40U) * 0x1p-24F;
}

/// A small stream of random numbers for building scenes; equal on every standard library. Two draws
/// never stand in the arguments of one call, whose order is the compiler's.
class HashStream {
 public:
  explicit constexpr HashStream(std::uint64_t seed) : state_(mix_bits(seed)) {}

  [[nodiscard]] constexpr std::uint64_t bits() { return mix_bits(state_++); }

  /// Uniform in [0, n), n > 0.
  [[nodiscard]] constexpr int below(int n) {
    return static_cast<int>(((bits() >> 32U) * static_cast<std::uint64_t>(n)) >> 32U);
  }

  /// Uniform in [low, high).
  [[nodiscard]] constexpr double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace stillmap
