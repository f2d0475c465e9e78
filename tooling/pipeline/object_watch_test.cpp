// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A watch, and the warnings that it gives.
struct Watched {
  std::vector<std::string> warnings;
  ObjectWatch watch;

  explicit Watched(const CategoryConfig& categories = {})
      : watch(categories, [this](const std::string& warning) { warnings.push_back(warning); }) {}

  void see(double stamp_s, const std::vector<std::pair<std::string, Category>>& objects = {}) {
    FrameResult result;
    result.stamp = {stamp_s, ""};
    for (const auto& [name, category] : objects) {
      ObjectState state;
      state.class_name = name;
      state.category = category;
      result.objects.push_back(state);
    }
    watch.on_frame(RgbdFrame(), result);
  }
  void end() { watch.on_end(RunResult()); }
};

constexpr Category kStatic = Category::kStatic, kDynamic = Category::kDynamic;

TEST(ObjectWatch, IsSilentWhereAPersonIsSeen) {
  Watched run;
  run.see(100);
  run.see(104.75, {{"chair", Category::kPotentiallyDynamic}, {"person", kDynamic}});
  run.see(110);
  run.end();
  EXPECT_THAT(run.warnings, IsEmpty());
  EXPECT_EQ(run.watch.first_dynamic_s(), 4.75);
}

TEST(ObjectWatch, WarnsAfterFiveSecondsOfStamps) {
  Watched run;
  run.see(100, {{"tv", kStatic}});
  run.see(104.9);
  EXPECT_THAT(run.warnings, IsEmpty());
  run.see(105);
  run.see(106);
  EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("in the first 5 s")));
  run.see(107.5, {{"person", kDynamic}});
  run.end();
  EXPECT_EQ(run.warnings.size(), 1U);
  EXPECT_EQ(run.watch.first_dynamic_s(), 7.5);
}

TEST(ObjectWatch, SaysWhenThereWasNone) {
  Watched run;
  run.see(100);
  run.see(101, {{"chair", Category::kPotentiallyDynamic}});
  run.end();
  EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("in any of 2 frames")));
  EXPECT_FALSE(run.watch.first_dynamic_s().has_value());
  Watched empty;
  empty.end();
  EXPECT_THAT(empty.warnings, IsEmpty());
}

TEST(ObjectWatch, NamesUnknownClassesOnce) {
  CategoryConfig categories;
  categories.synonyms = "trolley=suitcase";
  Watched run(categories);
  for (const double stamp_s : {1.0, 2.0}) {
    run.see(stamp_s,
            {{"person", kDynamic},
             {"pallet", kStatic},
             {"Trolley", kStatic},
             {"forklift", kStatic},
             {"tv", kStatic}});
  }
  run.end();
  EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("static: forklift, pallet; dynamics.")));
}

TEST(UnknownClassesWarning, NamesTen) {
  std::set<std::string> names;
  for (char c = 'a'; c < 'm'; ++c) names.insert(std::string(1, c));
  EXPECT_THAT(unknown_classes_warning(names), HasSubstr("a, b, c, d, e, f, g, h, i, j and 2 more"));
}

}  // namespace
}  // namespace stillmap
