// SPDX-License-Identifier: Apache-2.0
#include "fuzz/session_mutator.hpp"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/session_sections.hpp"

namespace stillmap {
namespace {

std::size_t pick(std::mt19937& rng, std::size_t count) {
  return rng() % count;
}

// Overwrites a number with one of those that are often too many, too few or none.
void put_special(std::string& content, std::mt19937& rng) {
  ByteWriter value;
  switch (pick(rng, 6)) {
    case 0:
      value.number(static_cast<std::uint32_t>(rng()));
      break;
    case 1:
      value.number(static_cast<std::uint32_t>(pick(rng, 16)));
      break;
    case 2:
      value.number(std::uint32_t{0xffffffff});
      break;
    case 3:
      value.number(1e9 * (static_cast<double>(rng()) / 2e9 - 1));
      break;
    case 4:
      value.number(static_cast<float>(rng()) / 1e9F - 2);
      break;
    default:
      value.number(std::numeric_limits<double>::quiet_NaN());
      break;
  }
  const std::string& bytes = value.bytes();
  if (content.size() < bytes.size()) return;
  content.replace(pick(rng, content.size() - bytes.size() + 1), bytes.size(), bytes);
}

}  // namespace

std::string mutate_session(std::string_view bytes,
                           std::size_t max_size,
                           std::mt19937& rng,
                           const ByteMutator& mutate_bytes) {
  std::vector<RawSection> sections = split_sections(bytes);
  if (sections.empty() || pick(rng, 50) == 0) return mutate_bytes(std::string(bytes), max_size);
  const std::size_t i = pick(rng, sections.size());
  const auto at = sections.begin() + static_cast<std::ptrdiff_t>(i);
  const std::size_t kind = pick(rng, 20);
  if (kind == 0) {
    sections.erase(at);
  } else if (kind == 1) {
    sections.insert(at, RawSection(*at));
  } else if (kind == 2) {
    std::swap(*at, sections[pick(rng, sections.size())]);
  } else if (kind < 10) {
    put_special(at->content, rng);
  } else {
    at->content = mutate_bytes(at->content, at->content.size() + 64);
  }
  std::string result = join_sections(sections);
  return result.size() <= max_size ? result : std::string(bytes);
}

}  // namespace stillmap
