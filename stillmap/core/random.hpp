// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "stillmap/core/ids.hpp"

namespace stillmap {

/// The purpose of a random generator. Each generator serves one purpose in one frame, so that an
/// additional draw for one purpose changes the draws of no other.
enum class RandomPurpose : std::uint32_t {
  kAbsolutePose = 1,
  kEpipolarGeometry = 2,
  kLoop = 3,
  kFloorPlane = 4
};

/// A new generator whose state depends only on the run's seed, the frame and the purpose.
[[nodiscard]] inline std::mt19937 rng_for(std::uint32_t seed,
                                          FrameId frame,
                                          RandomPurpose purpose) {
  std::seed_seq sequence{seed, frame.value, static_cast<std::uint32_t>(purpose)};
  return std::mt19937(sequence);
}

/// A uniform draw from [0, n). Unlike std::uniform_int_distribution it gives the same values with
/// every standard library.
[[nodiscard]] inline std::uint32_t draw_index(std::mt19937& rng, std::uint32_t n) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(rng()) * n) >> 32U);
}

}  // namespace stillmap
