// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {

/// A round of a camera in the middle of a world, 9 degrees a key frame, and the drift of its
/// tracking, which knows no loops.
struct RoundSpec {
  std::uint32_t keyframes = 44;  ///< 40 are a round; the others see again what the first saw
  /// The drift from one key frame to the next (perturb_left of the world).
  Vector6d drift = (Vector6d() << 0.006, 0.001, 0.002, 0.0005, 0.003, 0).finished();
  /// From this key frame on, key frames are in a second submap, unconnected to the first.
  std::optional<std::uint32_t> second_submap_from = std::nullopt;
  Eigen::Isometry3d T_second_first = Eigen::Isometry3d::Identity();
  ObservationNoise noise{.pixel_sigma_px = 0.5,
                         .inverse_depth_sigma = 0.004,
                         .wrong_descriptor_share = 0.2,
                         .flipped_bits = 10};
};

inline constexpr std::uint32_t kRoundKeyframes = 40;

/// True pose of the k-th key frame of a round.
[[nodiscard]] Eigen::Isometry3d round_pose(std::uint32_t k);

/// The map of a round: a landmark is matched again only if one of the last five key frames saw it.
[[nodiscard]] SimulatedMap drifted_round(const SimulatedWorld& world, const RoundSpec& spec);

/// Mean distance of the key frames from their true positions.
[[nodiscard]] double mean_error_m(const SimulatedMap& simulated);

}  // namespace stillmap
