// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"

namespace stillmap {

enum class DepthStability : std::uint8_t {
  kStable,
  kMissing,   ///< a pixel of the 3x3 block has no depth, or the block leaves the image
  kUnstable,  ///< the block spreads more than those of most features
};

struct DepthStabilityConfig {
  bool enabled = true;
  bool in_full = false;
  double mad_factor = 3.0;
  bool relative = true;
  std::string rejected = "depthless";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled",
          self.enabled,
          FieldInfo{"whether features are judged by the stability of the depth around them"});
    visit("in_full", self.in_full, FieldInfo{"whether mode full judges them, too"});
    visit("mad_factor",
          self.mad_factor,
          FieldInfo{
              "distance from the median spread, in scaled MADs, beyond which a feature is unstable",
              "",
              0.1,
              100});
    visit("relative",
          self.relative,
          FieldInfo{"full: whether spreads are divided by the noise of their depth"});
    visit("rejected",
          self.rejected,
          FieldInfo{"full: treatment of a feature of unstable depth; paper drops it, and one of "
                    "missing depth",
                    "",
                    0,
                    0,
                    {"keep", "depthless", "drop"}});
  }
};

/// The stability of the depth around each feature (Fan 2020, section III-E, Eq. (14)). A feature is
/// unstable if the standard deviation of the depths of its 3x3 block is more than `mad_factor`
/// scaled MADs from the median of all features with depth. With `relative`, deviations are first
/// divided by depth squared. `raw_px` are the raw pixels of the features; there is one result for
/// each.
[[nodiscard]] std::vector<DepthStability> judge_depth_stability(
    const DepthImage& depth,
    std::span<const Eigen::Vector2f> raw_px,
    const DepthStabilityConfig& config);

}  // namespace stillmap
