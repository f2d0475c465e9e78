// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stillmap {
namespace {

constexpr int kNoDistance = kDescriptorBits + 1;
constexpr std::uint32_t kNone = ~std::uint32_t{0};

struct BestTwo {
  int best = kNoDistance;
  int second = kNoDistance;
  int best_level = -1;
  int second_level = -1;
  std::uint32_t index = kNone;

  void offer(std::uint32_t candidate, int distance, int level) {
    if (distance < best) {
      second = best;
      second_level = best_level;
      best = distance;
      best_level = level;
      index = candidate;
    } else if (distance < second) {
      second = distance;
      second_level = level;
    }
  }

  [[nodiscard]] bool accepted(const MatchRules& rules) const {
    if (index == kNone || best > rules.max_distance) return false;
    // The second best on another level is most likely the same corner.
    return best_level != second_level || best <= rules.max_ratio * second;
  }
};

bool fits(const Projection& projection, const Features& features, std::uint32_t i) {
  const int level = features.level[i];
  if (level < projection.min_level || level > projection.max_level) return false;
  const Eigen::Vector2f offset = features.px[i] - projection.px;
  if (offset.squaredNorm() > projection.radius_px * projection.radius_px) return false;
  const float depth = features.depth_m[i];
  return depth <= 0 ||
         std::abs(1.0F / depth - projection.inverse_depth) <= projection.max_inverse_depth_error;
}

STILLMAP_POPCOUNT_CLONES
BestTwo best_feature(const Projection& projection,
                     const Features& features,
                     std::span<const std::uint8_t> taken) {
  BestTwo best;
  features.grid.visit_near(projection.px, projection.radius_px, [&](std::uint32_t i) {
    if ((!taken.empty() && taken[i] != 0) || !fits(projection, features, i)) return;
    best.offer(
        i, hamming_distance(*projection.descriptor, features.descriptors[i]), features.level[i]);
  });
  return best;
}

struct AllPairs {
  std::vector<BestTwo> best_of_a;  // per selected feature of a
  std::vector<std::uint32_t>
      nearest_to;  // per feature of b: position of the nearest selected feature
};

STILLMAP_POPCOUNT_CLONES
AllPairs compare_all(const Features& a,
                     std::span<const std::uint32_t> a_indices,
                     const Features& b) {
  AllPairs pairs{std::vector<BestTwo>(a_indices.size()),
                 std::vector<std::uint32_t>(b.size(), kNone)};
  std::vector<int> nearest(b.size(), kNoDistance);
  for (std::uint32_t place = 0; place < a_indices.size(); ++place) {
    const Descriptor& descriptor = a.descriptors[a_indices[place]];
    BestTwo& best = pairs.best_of_a[place];
    for (std::uint32_t i = 0; i < b.size(); ++i) {
      const int distance = hamming_distance(descriptor, b.descriptors[i]);
      best.offer(i, distance, 0);
      if (distance >= nearest[i]) continue;
      nearest[i] = distance;
      pairs.nearest_to[i] = place;
    }
  }
  return pairs;
}

// Keeps the match of least distance for each feature; the result is sorted by query.
std::vector<FeatureMatch> one_to_one(std::vector<FeatureMatch> matches, std::size_t feature_count) {
  std::vector<std::uint32_t> winner(feature_count, kNone);
  for (std::uint32_t m = 0; m < matches.size(); ++m) {
    std::uint32_t& current = winner[matches[m].feature];
    if (current == kNone || matches[m].distance < matches[current].distance) current = m;
  }
  std::vector<FeatureMatch> kept;
  kept.reserve(matches.size());
  for (std::uint32_t m = 0; m < matches.size(); ++m) {
    if (winner[matches[m].feature] == m) kept.push_back(matches[m]);
  }
  return kept;
}

}  // namespace

std::vector<FeatureMatch> match_projections(std::span<const Projection> projections,
                                            const Features& features,
                                            std::span<const std::uint8_t> taken,
                                            const MatchRules& rules) {
  std::vector<FeatureMatch> matches;
  matches.reserve(projections.size());
  for (std::uint32_t p = 0; p < projections.size(); ++p) {
    const BestTwo best = best_feature(projections[p], features, taken);
    if (best.accepted(rules)) matches.push_back({p, best.index, best.best});
  }
  return one_to_one(std::move(matches), features.size());
}

std::vector<FeatureMatch> match_all(const Features& a,
                                    std::span<const std::uint32_t> a_indices,
                                    const Features& b,
                                    const MatchRules& rules) {
  const AllPairs pairs = compare_all(a, a_indices, b);
  std::vector<FeatureMatch> matches;
  for (std::uint32_t place = 0; place < a_indices.size(); ++place) {
    const BestTwo& best = pairs.best_of_a[place];
    if (!best.accepted(rules) || pairs.nearest_to[best.index] != place) continue;
    matches.push_back({a_indices[place], best.index, best.best});
  }
  return matches;
}

std::vector<FeatureMatch> keep_consistent_rotations(std::span<const FeatureMatch> matches,
                                                    std::span<const float> query_angles_deg,
                                                    std::span<const float> feature_angles_deg) {
  constexpr int kBins = 30;
  const auto bin_of = [&](const FeatureMatch& match) {
    float turn = query_angles_deg[match.query] - feature_angles_deg[match.feature];
    if (turn < 0) turn += 360.0F;
    return static_cast<std::size_t>(std::lround(turn * kBins / 360.0F)) % kBins;
  };
  std::array<int, kBins> counts{};
  for (const FeatureMatch& match : matches) ++counts[bin_of(match)];

  std::array<std::size_t, kBins> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](auto l, auto r) { return counts[l] > counts[r]; });
  std::array<bool, kBins> good{};
  for (std::size_t rank = 0; rank < 3; ++rank) {
    // Bins with far fewer matches than the fullest hold chance matches.
    good[order[rank]] = counts[order[rank]] * 10 >= counts[order[0]];
  }
  std::vector<FeatureMatch> kept;
  for (const FeatureMatch& match : matches) {
    if (good[bin_of(match)]) kept.push_back(match);
  }
  return kept;
}

}  // namespace stillmap
