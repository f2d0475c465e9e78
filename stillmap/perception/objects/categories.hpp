// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

/// The classes of two categories: names that coco_name() knows, separated by commas. Every other
/// class is static. By default every COCO class has a category. Static are those that are built in
/// or too heavy to carry (traffic light, fire hydrant, stop sign, parking meter, bed, dining table,
/// toilet, tv, microwave, oven, toaster, sink, refrigerator).
struct CategoryConfig {
  std::string dynamic = "person, bird, cat, dog, horse, sheep, cow, elephant, bear, zebra, giraffe";
  std::string potentially_dynamic =
      "chair, couch, bench, book, keyboard, mouse, laptop, remote, cell phone, bottle, wine glass, "
      "cup, bowl, fork, knife, spoon, backpack, handbag, suitcase, umbrella, tie, frisbee, "
      "sports ball, kite, baseball bat, baseball glove, skateboard, tennis racket, snowboard, "
      "skis, surfboard, banana, apple, sandwich, orange, broccoli, carrot, hot dog, pizza, donut, "
      "cake, potted plant, vase, scissors, teddy bear, hair drier, toothbrush, clock, bicycle, "
      "motorcycle, car, bus, truck, train, boat, airplane";
  std::string synonyms = {};  ///< "forklift=truck, dummy=person"

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("dynamic",
          self.dynamic,
          common_setting(FieldInfo{"classes that move by themselves, separated by commas"}));
    visit("potentially_dynamic",
          self.potentially_dynamic,
          common_setting(FieldInfo{
              "classes that people move, separated by commas; all other classes are static"}));
    visit("synonyms",
          self.synonyms,
          common_setting(FieldInfo{
              "classes of a network by classes of COCO, such as forklift=truck, separated by "
              "commas"}));
  }
};

/// The category of each class. A class has the same category under all its names.
class CategoryTable {
 public:
  /// Throws Error, with the key and the name, for a name that COCO does not have, an empty name, a
  /// repeated name, and a synonym that already is the name of a class.
  explicit CategoryTable(const CategoryConfig& config);

  /// The category of a class; static for a class in no list.
  [[nodiscard]] Category of(std::string_view class_name) const;

  /// Whether a class is one of COCO's, by one of its names or by a synonym. Other classes are
  /// static only because they are unknown.
  [[nodiscard]] bool knows(std::string_view class_name) const;

 private:
  struct Synonym {
    std::string name;
    std::string coco;
  };
  void add(std::string_view key, const std::string& list, Category category);
  void add_synonym(std::string_view pair);
  [[nodiscard]] std::string known_name(std::string_view class_name) const;

  struct Entry {
    std::string name;
    Category category = Category::kStatic;
  };
  std::vector<Entry> entries_;  // by name
  std::vector<Synonym> synonyms_;
};

}  // namespace stillmap
