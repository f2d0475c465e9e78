// SPDX-License-Identifier: Apache-2.0
#include "stillmap/core/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/joined.hpp"

namespace stillmap {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Another digit names another thing: k4 is no misspelt k1.
std::size_t substitution_cost(char a, char b) {
  if (a == b) return 0;
  return is_digit(a) && is_digit(b) ? 2 : 1;
}

// Levenshtein distance, computed one row at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitute = diagonal + substitution_cost(a[i], b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string name_hint(std::string_view misspelt, std::span<const std::string> known) {
  const auto nearest = std::ranges::min_element(
      known, {}, [&](const std::string& name) { return edit_distance(misspelt, name); });
  if (edit_distance(misspelt, *nearest) <= std::max<std::size_t>(1, (nearest->size() + 1) / 3)) {
    return fmt::format("did you mean '{}'?", *nearest);
  }
  return fmt::format("known: {}", joined(known, ", "));
}

}  // namespace stillmap
