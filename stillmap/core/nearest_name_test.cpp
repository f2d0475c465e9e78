// SPDX-License-Identifier: Apache-2.0
#include "stillmap/core/nearest_name.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

const std::vector<std::string> kNames = {"tracking.features", "cloud.voxel_size_m", "seed"};

TEST(NameHint, SuggestsACloseName) {
  EXPECT_EQ(name_hint("tracking.feature", kNames), "did you mean 'tracking.features'?");
  EXPECT_EQ(name_hint("cloud.voxelsize_m", kNames), "did you mean 'cloud.voxel_size_m'?");
  EXPECT_EQ(name_hint("emtpy", std::vector<std::string>{"loop", "empty"}), "did you mean 'empty'?");
  EXPECT_EQ(name_hint("sead", kNames), "did you mean 'seed'?");
}

TEST(NameHint, TakesAnotherDigitForAnotherName) {
  const std::vector<std::string> lens = {"fx", "k1", "k2"};
  EXPECT_EQ(name_hint("k7", lens), "known: fx, k1, k2");
  EXPECT_EQ(name_hint("k", lens), "did you mean 'k1'?");
  EXPECT_EQ(name_hint("tum_f1", std::vector<std::string>{"tum_fr3", "tum_fr1"}),
            "did you mean 'tum_fr1'?");
}

TEST(NameHint, ListsAllWhenNoneIsClose) {
  EXPECT_EQ(name_hint("zzzzzzzz", kNames), "known: tracking.features, cloud.voxel_size_m, seed");
  EXPECT_EQ(name_hint("", kNames), "known: tracking.features, cloud.voxel_size_m, seed");
}

}  // namespace
}  // namespace stillmap
