// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "stillmap/core/ids.hpp"

namespace stillmap {

/// What a random generator is for; a generator serves one purpose in one frame, so that adding a
/// draw in one place changes no other.
enum class RandomPurpose : std::uint32_t {
  kAbsolutePose = 1,
  kEpipolarGeometry = 2,
  kLoop = 3,
  kFloorPlane = 4
};

/// A fresh generator that depends on the run's seed, the frame and the purpose alone.
[[nodiscard]] inline std::mt19937 rng_for(std::uint32_t seed,
                                          FrameId frame,
                                          RandomPurpose purpose) {
  std::seed_seq sequence{seed, frame.value, static_cast<std::uint32_t>(purpose)};
  return std::mt19937(sequence);
}

/// Uniform in [0, n), the same on every standard library (std::uniform_int_distribution is not).
[[nodiscard]] inline std::uint32_t draw_index(std::mt19937& rng, std::uint32_t n) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(rng()) * n) >> 32U);
}

}  // namespace stillmap
