// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// Where a known point is expected in an image, and what it looks like.
struct Projection {
  Eigen::Vector2f px;                 ///< ideal pixel
  float radius_px = 0;                ///< how far from there it may be
  float inverse_depth = 0;            ///< expected, 1/m
  float max_inverse_depth_error = 0;  ///< 1/m; features without depth pass
  int min_level = 0;                  ///< of the pyramid, inclusive
  int max_level = 0;
  const Descriptor* descriptor = nullptr;
};

struct FeatureMatch {
  std::uint32_t query = 0;    ///< index of the projection or of the first feature
  std::uint32_t feature = 0;  ///< index in the features searched
  int distance = 0;           ///< Hamming
};

struct MatchRules {
  int max_distance = 100;  ///< Hamming, of 256
  double max_ratio = 1.0;  ///< best to second best distance, asked where both are on one level

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_distance",
          self.max_distance,
          FieldInfo{
              "differing bits of the 256 of two descriptors that match, at most", "bits", 0, 256});
    visit("max_ratio",
          self.max_ratio,
          FieldInfo{"distance of the best match to that of the second best on the same pyramid "
                    "level, at most; 1 accepts any",
                    "",
                    0,
                    1});
  }
};

/// The best feature for each projection, one to one: of several projections that want one feature
/// the nearest in appearance gets it (ties: the earlier). Features with `taken[i] != 0` are left
/// out; `taken` is empty or has a value per feature. Sorted by query.
[[nodiscard]] std::vector<FeatureMatch> match_projections(std::span<const Projection> projections,
                                                          const Features& features,
                                                          std::span<const std::uint8_t> taken,
                                                          const MatchRules& rules);

/// Mutual best matches by appearance alone between the features of `a` chosen by `a_indices` and
/// all of `b` (ties: the earlier). In the order of `a_indices`; the query is an index into `a`.
[[nodiscard]] std::vector<FeatureMatch> match_all(const Features& a,
                                                  std::span<const std::uint32_t> a_indices,
                                                  const Features& b,
                                                  const MatchRules& rules);

/// Keeps the matches whose change of orientation agrees with the three most common changes
/// (12-degree bins): a wrong match turns by any angle, right ones turn together. `query_angles_deg`
/// is indexed by query.
[[nodiscard]] std::vector<FeatureMatch> keep_consistent_rotations(
    std::span<const FeatureMatch> matches,
    std::span<const float> query_angles_deg,
    std::span<const float> feature_angles_deg);

}  // namespace stillmap
