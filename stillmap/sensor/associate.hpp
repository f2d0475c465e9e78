// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace stillmap {

/// Stamps closer than this belong together: the TUM benchmark's default, seconds.
inline constexpr double kMaxStampDifferenceS = 0.02;

/// Pairs stamps of two lists, as the TUM benchmark does: of all pairs less than `max_difference_s`
/// apart the closest first, each stamp used once (among equally close pairs the earlier in `a`,
/// then in `b`). Both lists are strictly increasing; the result holds indices (into a, into b) in
/// the order of `a`. Takes O(n log n), also where very many stamps lie close together.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> associate(std::span<const double> a,
                                                                         std::span<const double> b,
                                                                         double max_difference_s);

}  // namespace stillmap
