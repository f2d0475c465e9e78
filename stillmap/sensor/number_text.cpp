// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/number_text.hpp"

#include <algorithm>
#include <optional>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"

namespace stillmap {

std::vector<double> numbers_in(std::string_view text,
                               const std::string& place,
                               std::size_t expected) {
  constexpr std::string_view kBetween = " \t\r\n,";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
       at = text.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::optional<double> value = parse_number<double>(text.substr(at, end - at));
    if (!value) {
      throw Error("{}: not a list of numbers, expected {} of them",
                  place,
                  expected == 0 ? "any count" : std::to_string(expected));
    }
    numbers.push_back(*value);
    at = end;
  }
  if (expected != 0 && numbers.size() != expected) {
    throw Error("{}: {} numbers, expected {}", place, numbers.size(), expected);
  }
  return numbers;
}

}  // namespace stillmap
