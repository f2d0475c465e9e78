// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>

#include "stillmap/core/random.hpp"

namespace stillmap {

/// Indices below a population's size, of the items that one model is made from.
template <std::size_t kSize>
using Sample = std::array<std::uint32_t, kSize>;

/// Draws with replacement: an index may come twice. `population` is at least 1.
template <std::size_t kSize>
[[nodiscard]] Sample<kSize> draw_with_replacement(std::mt19937& rng, std::uint32_t population) {
  Sample<kSize> sample;
  for (std::uint32_t& index : sample) index = draw_index(rng, population);
  return sample;
}

/// Draws without replacement: no index comes twice. `population` is at least kSize.
template <std::size_t kSize>
[[nodiscard]] Sample<kSize> draw_without_replacement(std::mt19937& rng, std::uint32_t population) {
  Sample<kSize> sample;
  auto end = sample.begin();
  while (end != sample.end()) {
    const std::uint32_t index = draw_index(rng, population);
    if (std::find(sample.begin(), end, index) == end) *end++ = index;
  }
  return sample;
}

/// Iterations after which a sample of inliers alone has been drawn with a probability of 99.5 %,
/// where `inliers` of `population` are, between 1 and `at_most` (Fischler and Bolles 1981).
[[nodiscard]] int ransac_iterations(int inliers,
                                    std::size_t population,
                                    std::size_t sample_size,
                                    int at_most);

/// A model and the support it has, as far as its caller measures it.
template <class Model, class Support>
struct Consensus {
  Model model;
  Support support;
};

/// Random sample consensus (Fischler and Bolles 1981): of the models that `propose()` makes from
/// random samples the one with the greatest `support_of(model)`, of equal ones the earliest.
///
/// `propose()` returns an optional model, nothing for a sample that tells none. A support is
/// compared by `<`; nothing is returned where no model has more than `least`. After each best model
/// `needed(support)` says how many iterations are enough in all.
template <class Support, class Propose, class SupportOf, class Needed>
[[nodiscard]] auto ransac(
    int max_iterations, Support least, Propose propose, SupportOf support_of, Needed needed) {
  using Model = typename decltype(propose())::value_type;
  std::optional<Consensus<Model, Support>> best;
  int iterations = max_iterations;
  for (int i = 0; i < iterations; ++i) {
    std::optional<Model> model = propose();
    if (!model) continue;
    Support support = support_of(std::as_const(*model));
    if (!((best ? best->support : least) < support)) continue;
    iterations = std::min(max_iterations, needed(std::as_const(support)));
    best = {std::move(*model), std::move(support)};
  }
  return best;
}

/// The same with a fixed number of iterations.
template <class Support, class Propose, class SupportOf>
[[nodiscard]] auto ransac(int iterations, Support least, Propose propose, SupportOf support_of) {
  return ransac(iterations, std::move(least), propose, support_of, [iterations](const Support&) {
    return iterations;
  });
}

}  // namespace stillmap
