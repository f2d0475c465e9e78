// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/categories.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Categories, DefaultsSortTheClassesOfAnOffice) {
  const CategoryTable table{CategoryConfig{}};
  EXPECT_EQ(table.of("person"), Category::kDynamic);
  EXPECT_EQ(table.of("dog"), Category::kDynamic);
  EXPECT_EQ(table.of("chair"), Category::kPotentiallyDynamic);
  EXPECT_EQ(table.of("suitcase"), Category::kPotentiallyDynamic);
  EXPECT_EQ(table.of("tv"), Category::kStatic);
  EXPECT_EQ(table.of("dining table"), Category::kStatic);
}

// No class is static by omission.
TEST(Categories, EveryStaticClassOfCocoIsBuiltInOrHeavy) {
  const CategoryTable table{CategoryConfig{}};
  std::vector<std::string_view> fixed;
  for (const std::string_view name : coco_class_names()) {
    if (table.of(name) == Category::kStatic) fixed.push_back(name);
  }
  EXPECT_THAT(fixed,
              testing::UnorderedElementsAre("traffic light",
                                            "fire hydrant",
                                            "stop sign",
                                            "parking meter",
                                            "bed",
                                            "dining table",
                                            "toilet",
                                            "tv",
                                            "microwave",
                                            "oven",
                                            "toaster",
                                            "sink",
                                            "refrigerator"));
  for (const char* food : {"broccoli", "carrot", "hot dog", "donut", "cake", "pizza"}) {
    EXPECT_EQ(table.of(food), Category::kPotentiallyDynamic) << food;
  }
}

TEST(Categories, NamesOfPeopleAreDynamic) {
  const CategoryTable table{CategoryConfig{}};
  for (const char* name : {"Person", "pedestrian", "human", "Man", "worker"}) {
    EXPECT_EQ(table.of(name), Category::kDynamic) << name;
  }
}

TEST(Categories, SynonymsComeFromTheConfiguration) {
  CategoryConfig config;
  config.synonyms = " forklift = truck, Crash Dummy=human ";
  const CategoryTable table(config);
  EXPECT_EQ(table.of("Forklift"), Category::kPotentiallyDynamic);
  EXPECT_EQ(table.of("crash_dummy"), Category::kDynamic);
  EXPECT_TRUE(table.knows("FORKLIFT"));
  EXPECT_TRUE(table.knows("sofa"));
  EXPECT_FALSE(table.knows("stapler"));
  EXPECT_FALSE(CategoryTable{CategoryConfig{}}.knows("forklift"));
}

TEST(Categories, BadSynonymsAreRefused) {
  const auto make = [](const char* synonyms) {
    return [=] {
      CategoryConfig config;
      config.synonyms = synonyms;
      return CategoryTable(config);
    };
  };
  const auto refuses = [](const char* what) {
    return ThrowsMessage<Error>(AllOf(HasSubstr("categories.synonyms"), HasSubstr(what)));
  };
  EXPECT_THAT(make("forklift"), refuses("name=class"));
  EXPECT_THAT(make("=person"), refuses("name=class"));
  EXPECT_THAT(make("a=person,"), refuses("name=class"));
  EXPECT_THAT(make("forklift="), refuses("empty"));
  EXPECT_THAT(make("forklift=trukc"), refuses("did you mean 'truck'?"));
  EXPECT_THAT(make("man=chair"), refuses("'man' means 'person' already"));
  EXPECT_THAT(make("a=person, A=dog"), refuses("'A' means 'person' already"));
}

TEST(Categories, AnUnknownClassIsStatic) {
  EXPECT_EQ(CategoryTable{CategoryConfig{}}.of("stapler"), Category::kStatic);
}

TEST(Categories, NamesOfVocAreTheSameClasses) {
  const CategoryTable defaults{CategoryConfig{}};
  EXPECT_EQ(defaults.of("sofa"), defaults.of("couch"));
  const CategoryTable table({.dynamic = "person", .potentially_dynamic = "tvmonitor"});
  EXPECT_EQ(table.of("tv"), Category::kPotentiallyDynamic);
}

TEST(Categories, ListsMayBeEmptyAndBlanksDoNotMatter) {
  const CategoryTable table({.dynamic = "  cat ,person\t", .potentially_dynamic = " "});
  EXPECT_EQ(table.of("cat"), Category::kDynamic);
  EXPECT_EQ(table.of("person"), Category::kDynamic);
  EXPECT_EQ(table.of("chair"), Category::kStatic);
}

TEST(Categories, BadListsAreRefusedWithKeyAndName) {
  const auto make = [](const char* dynamic, const char* potential) {
    return [=] { return CategoryTable({.dynamic = dynamic, .potentially_dynamic = potential}); };
  };
  EXPECT_THAT(make("persn", "chair"),
              ThrowsMessage<Error>(AllOf(HasSubstr("categories.dynamic"),
                                         HasSubstr("'persn'"),
                                         HasSubstr("did you mean 'person'?"))));
  EXPECT_THAT(
      make("person", "chair,,cup"),
      ThrowsMessage<Error>(AllOf(HasSubstr("categories.potentially_dynamic"), HasSubstr("empty"))));
  EXPECT_THAT(make("person", "cup,"), ThrowsMessage<Error>(HasSubstr("empty")));
  EXPECT_THAT(make("person, chair", "chair"),
              ThrowsMessage<Error>(AllOf(HasSubstr("'chair'"), HasSubstr("twice"))));
  EXPECT_THAT(make("person", "tv, tvmonitor"), ThrowsMessage<Error>(HasSubstr("twice")));
}

}  // namespace
}  // namespace stillmap
