// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "stillmap/core/images.hpp"

namespace stillmap {

/// What depth images tell of their unit. All values are as stored.
struct DepthUnitEvidence {
  std::size_t pixels = 0;  ///< with depth; the rest is 0 without any
  double near = 0;         ///< two in a hundred pixels are nearer
  double median = 0;       ///< half of the pixels are nearer
  double far = 0;          ///< two in a hundred pixels are farther
  bool in_fives = false;   ///< whether all but one in a thousand are multiples of 5

  /// The units of a stored value per metre, 1000 or 5000, if one alone is plausible for a camera in
  /// a room: 1000 for depths of at least 0.1 m, most of them within 6 m, hardly any beyond 12 m;
  /// 5000, which Kinect and Xtion recordings in the TUM layout have, for depths from 0.4 m. Between
  /// both, multiples of 5 decide: they are millimetres in units of 1/5000 m.
  [[nodiscard]] std::optional<double> depth_factor() const;
};

/// Gathers the evidence of images whose depth is as stored: read with a depth factor of 1.
[[nodiscard]] DepthUnitEvidence depth_unit_evidence(std::span<const DepthImage> stored);

}  // namespace stillmap
