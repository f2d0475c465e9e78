// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/class_names.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(ClassNames, StandWhereNetworksHaveThem) {
  const std::span<const std::string_view> names = coco_class_names();
  ASSERT_EQ(names.size(), 80U);
  EXPECT_EQ(names[0], "person");
  EXPECT_EQ(names[39], "bottle");
  EXPECT_EQ(names[56], "chair");
  EXPECT_EQ(names[62], "tv");
  EXPECT_EQ(names[79], "toothbrush");
  EXPECT_EQ(std::set<std::string_view>(names.begin(), names.end()).size(), 80U);
}

TEST(ClassNames, VocsOwnNamesBecomeCocos) {
  for (const char* voc :
       {"aeroplane", "bicycle",     "bird",  "boat", "bottle", "bus",      "car",
        "cat",       "chair",       "cow",   "dog",  "horse",  "person",   "diningtable",
        "motorbike", "pottedplant", "sheep", "sofa", "train",  "tvmonitor"}) {
    EXPECT_TRUE(is_coco_class(coco_name(voc))) << voc;
  }
  EXPECT_EQ(coco_name("tvmonitor"), "tv");
  EXPECT_EQ(coco_name("diningtable"), "dining table");
  EXPECT_EQ(coco_name("forklift"), "forklift");
  EXPECT_FALSE(is_coco_class("box"));
  EXPECT_FALSE(is_coco_class(""));
}

TEST(ClassNames, EveryNameOfAClassIsItsOwn) {
  for (const std::string_view name : coco_class_names()) {
    EXPECT_EQ(coco_name(name), name);
    std::string shouted(name);
    for (char& c : shouted) c = c == ' ' ? '_' : static_cast<char>(std::toupper(c));
    EXPECT_EQ(coco_name(shouted), name);
  }
}

TEST(ClassNames, SynonymsOfPeopleAndFurniture) {
  for (const char* name : {"Person",
                           "PERSON",
                           "pedestrian",
                           "human",
                           "people",
                           "man",
                           "woman",
                           "boy",
                           "girl",
                           "child",
                           "Worker",
                           "Rider"}) {
    EXPECT_EQ(coco_name(name), "person") << name;
  }
  for (const char* name : {"diningtable", "Dining Table", "dining-table", "table", "TABLE"}) {
    EXPECT_EQ(coco_name(name), "dining table") << name;
  }
  EXPECT_EQ(coco_name("Sofa"), "couch");
  EXPECT_EQ(coco_name("monitor"), "tv");
  EXPECT_EQ(coco_name("television"), "tv");
}

TEST(ClassNames, OtherNamesStayAsTheyAre) {
  for (const char* name : {"Forklift", "manhole", "tables", "", "--", "persona"}) {
    EXPECT_EQ(coco_name(name), name);
  }
}

TEST(ClassNames, SameButForCaseAndSigns) {
  EXPECT_TRUE(is_same_name("Pallet Jack", "pallet_jack"));
  EXPECT_FALSE(is_same_name("pallet", "pallets"));
  EXPECT_FALSE(is_same_name("--", "++"));
  EXPECT_FALSE(is_same_name("\u4EBA 1", "\u8F66 1"));
}

TEST(ClassNames, AreTextsOfAnyLanguage) {
  for (const char* name : {"a", "Fu\u00DFg\u00E4nger", "\u4EBA", "\U0001F408", "a b", "\"'"}) {
    EXPECT_TRUE(is_class_name(name)) << name;
    EXPECT_EQ(usable_class_name(name), name);
  }
  // A cut character, an overlong one, a surrogate, one beyond Unicode, control characters.
  for (const char* name : {"",
                           "\xC3",
                           "\xC0\xAF",
                           "\xED\xA0\x80",
                           "\xF4\x90\x80\x80",
                           "\xFF",
                           "a\n",
                           "\x7F",
                           "\u0085"}) {
    EXPECT_FALSE(is_class_name(name)) << name;
    EXPECT_TRUE(is_class_name(usable_class_name(name))) << name;
  }
  EXPECT_EQ(usable_class_name("p\xFF\u00E9\n"), "p?\u00E9?");
  EXPECT_TRUE(is_class_name(std::string(256, 'a')));
  EXPECT_FALSE(is_class_name(std::string(257, 'a')));
  const std::string most(255, 'a');
  EXPECT_EQ(usable_class_name(fmt::format("{}\u00E9", most)), most);
}

}  // namespace
}  // namespace stillmap
