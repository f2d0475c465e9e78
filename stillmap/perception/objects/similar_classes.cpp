// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/similar_classes.hpp"

#include <algorithm>
#include <array>

namespace stillmap {
namespace {

constexpr std::array<std::array<std::string_view, 4>, 5> kSimilar = {{
    {"chair", "couch", "bench", "toilet"},
    {"dining table", "bed", "desk", ""},
    {"tv", "laptop", "microwave", ""},
    {"bottle", "cup", "vase", "wine glass"},
    {"backpack", "handbag", "suitcase", ""},
}};

}  // namespace

bool similar_classes(std::string_view a, std::string_view b) {
  return a == b || std::ranges::any_of(kSimilar, [&](const auto& group) {
           return std::ranges::find(group, a) != group.end() &&
                  std::ranges::find(group, b) != group.end();
         });
}

}  // namespace stillmap
