// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/class_names.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

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
}

}  // namespace
}  // namespace stillmap
