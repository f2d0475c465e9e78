// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/class_names.hpp"

#include <algorithm>
#include <set>

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

}  // namespace
}  // namespace stillmap
