// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// The predicted position and appearance of a known point in an image.
struct Projection {
  Eigen::Vector2f px;                 ///< ideal pixel
  float radius_px = 0;                ///< search radius around `px`
  float inverse_depth = 0;            ///< predicted, 1/m
  float max_inverse_depth_error = 0;  ///< 1/m; features without depth pass
  int min_level = 0;                  ///< of the pyramid, inclusive
  int max_level = 0;
  const Descriptor* descriptor = nullptr;
};

struct FeatureMatch {
  std::uint32_t query = 0;    ///< index of the projection or of the first feature
  std::uint32_t feature = 0;  ///< index of the matched feature
  int distance = 0;           ///< Hamming
};

struct MatchRules {
  int max_distance = 100;  ///< Hamming, of 256
  double max_ratio = 1.0;  ///< best to second best distance, asked where both are on one level

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_distance",
          self.max_distance,
          FieldInfo{"greatest Hamming distance of the descriptors of a match", "bits", 0, 256});
    visit("max_ratio",
          self.max_ratio,
          FieldInfo{
              "greatest ratio of best to second best distance on one pyramid level; 1 accepts any",
              "",
              0,
              1});
  }
};

/// The best feature for each projection, one to one: if several projections match one feature, the
/// nearest in appearance gets it (ties: the earlier). Features with `taken[i] != 0` are left out;
/// `taken` is empty or has one value per feature. Sorted by query.
[[nodiscard]] std::vector<FeatureMatch> match_projections(std::span<const Projection> projections,
                                                          const Features& features,
                                                          std::span<const std::uint8_t> taken,
                                                          const MatchRules& rules);

/// The mutual best matches by appearance alone between the features `a_indices` of `a` and all
/// features of `b` (ties: the earlier), in the order of `a_indices`. The query is an index into
/// `a`.
[[nodiscard]] std::vector<FeatureMatch> match_all(const Features& a,
                                                  std::span<const std::uint32_t> a_indices,
                                                  const Features& b,
                                                  const MatchRules& rules);

/// Keeps the matches whose change of orientation is among the three most common changes (12-degree
/// bins): correct matches rotate together, wrong ones by any angle. `query_angles_deg` is indexed
/// by query.
[[nodiscard]] std::vector<FeatureMatch> keep_consistent_rotations(
    std::span<const FeatureMatch> matches,
    std::span<const float> query_angles_deg,
    std::span<const float> feature_angles_deg);

}  // namespace stillmap
