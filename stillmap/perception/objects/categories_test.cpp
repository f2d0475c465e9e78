// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/categories.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

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
