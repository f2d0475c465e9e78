// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

/// The classes of two categories: names of COCO (or of VOC for the same classes), separated by
/// commas. Every other class is static.
struct CategoryConfig {
  std::string dynamic = "person, bird, cat, dog, horse, sheep, cow, elephant, bear, zebra, giraffe";
  std::string potentially_dynamic =
      "chair, couch, bench, book, keyboard, mouse, laptop, remote, cell phone, bottle, wine glass, "
      "cup, bowl, fork, knife, spoon, backpack, handbag, suitcase, umbrella, tie, frisbee, "
      "sports ball, kite, baseball bat, baseball glove, skateboard, tennis racket, snowboard, "
      "skis, surfboard, banana, apple, sandwich, orange, pizza, potted plant, vase, scissors, "
      "teddy bear, hair drier, toothbrush, clock, bicycle, motorcycle, car, bus, truck, train, "
      "boat, airplane";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("dynamic",
          self.dynamic,
          common_setting(FieldInfo{"classes that move by themselves, separated by commas"}));
    visit("potentially_dynamic",
          self.potentially_dynamic,
          common_setting(FieldInfo{
              "classes that people move, separated by commas; all other classes are static"}));
  }
};

/// The category of each class. A class has the same category under its VOC and its COCO name.
class CategoryTable {
 public:
  /// Throws Error, with the key and the name, for a name that COCO does not have, an empty name,
  /// and a repeated name.
  explicit CategoryTable(const CategoryConfig& config);

  /// The category of a class; static for a class in no list.
  [[nodiscard]] Category of(std::string_view class_name) const;

 private:
  void add(std::string_view key, const std::string& list, Category category);

  struct Entry {
    std::string name;
    Category category = Category::kStatic;
  };
  std::vector<Entry> entries_;  // by name
};

}  // namespace stillmap
