// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/categories.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string checked_name(std::string_view key, std::string_view name) {
  if (name.empty()) {
    throw Error("{}: a name is empty: expected names separated by single commas", key);
  }
  std::string coco = coco_name(name);
  if (is_coco_class(coco)) return coco;
  const std::span<const std::string_view> names = coco_class_names();
  const std::vector<std::string> known(names.begin(), names.end());
  throw Error("{}: expected classes of COCO, got '{}': {}",
              key,
              name.substr(0, 60),
              name_hint(name.substr(0, 60), known));
}

// The parts of a list between its commas, trimmed; none of an empty list.
std::vector<std::string_view> parts_of(std::string_view list) {
  std::vector<std::string_view> parts;
  std::string_view rest = trimmed(list);
  bool more = !rest.empty();
  while (more) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    parts.push_back(trimmed(rest.substr(0, comma)));
    rest = more ? rest.substr(comma + 1) : std::string_view{};
  }
  return parts;
}

}  // namespace

CategoryTable::CategoryTable(const CategoryConfig& config) {
  add("categories.dynamic", config.dynamic, Category::kDynamic);
  add("categories.potentially_dynamic", config.potentially_dynamic, Category::kPotentiallyDynamic);
  for (const std::string_view pair : parts_of(config.synonyms)) add_synonym(pair);
}

void CategoryTable::add(std::string_view key, const std::string& list, Category category) {
  for (const std::string_view part : parts_of(list)) {
    const std::string name = checked_name(key, part);
    const auto place = std::ranges::lower_bound(entries_, name, {}, &Entry::name);
    if (place != entries_.end() && place->name == name) {
      throw Error("{}: '{}' stands twice in the lists of categories: expected once", key, name);
    }
    entries_.insert(place, {name, category});
  }
}

void CategoryTable::add_synonym(std::string_view pair) {
  constexpr std::string_view kKey = "categories.synonyms";
  const std::size_t sign = pair.find('=');
  const std::string_view name = trimmed(pair.substr(0, sign));
  if (sign == std::string_view::npos || name.empty()) {
    throw Error("{}: expected name=class separated by commas, such as forklift=truck, got '{}'",
                kKey,
                pair.substr(0, 60));
  }
  if (knows(name)) {
    throw Error("{}: '{}' means '{}' already: expected a name that is none of a class",
                kKey,
                name.substr(0, 60),
                known_name(name));
  }
  synonyms_.push_back({std::string(name), checked_name(kKey, trimmed(pair.substr(sign + 1)))});
}

std::string CategoryTable::known_name(std::string_view class_name) const {
  const auto found = std::ranges::find_if(
      synonyms_, [&](const Synonym& synonym) { return is_same_name(synonym.name, class_name); });
  return found == synonyms_.end() ? coco_name(class_name) : found->coco;
}

bool CategoryTable::knows(std::string_view class_name) const {
  return is_coco_class(known_name(class_name));
}

Category CategoryTable::of(std::string_view class_name) const {
  const std::string name = known_name(class_name);
  const auto place = std::ranges::lower_bound(entries_, name, {}, &Entry::name);
  return place != entries_.end() && place->name == name ? place->category : Category::kStatic;
}

}  // namespace stillmap
