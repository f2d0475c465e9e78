// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/metrics_json.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(MetricsJson, HasTheKeysInOrder) {
  AteResult ate;
  ate.translation_m = {.rmse = 6, .mean = 5, .median = 4, .std = 3, .min = 2, .max = 1};
  ate.pairs.resize(7);
  EXPECT_EQ(ate_json(ate).dump(),
            R"({"rmse":6.0,"mean":5.0,"median":4.0,"std":3.0,"min":2.0,"max":1.0,"pairs":7})");
  RpeResult rpe;
  rpe.pairs = 9;
  rpe.translation_m = {.rmse = 6, .mean = 5, .median = 4, .std = 3, .min = 2, .max = 1};
  rpe.rotation_deg = {.rmse = 16, .mean = 15, .median = 14, .std = 13, .min = 12, .max = 11};
  EXPECT_EQ(rpe_json(rpe).dump(),
            R"({"delta_s":1.0,"pairs":9,)"
            R"("trans":{"rmse":6.0,"mean":5.0,"median":4.0,"std":3.0,"max":1.0},)"
            R"("rot_deg":{"rmse":16.0,"mean":15.0,"median":14.0,"std":13.0,"max":11.0}})");
}

TEST(MetricsJson, IsNullWhereNothingIsKnown) {
  EXPECT_EQ(ate_json(std::nullopt).dump(),
            R"({"rmse":null,"mean":null,"median":null,"std":null,"min":null,"max":null,)"
            R"("pairs":null})");
  EXPECT_EQ(rpe_json(std::nullopt).dump(),
            R"({"delta_s":null,"pairs":null,)"
            R"("trans":{"rmse":null,"mean":null,"median":null,"std":null,"max":null},)"
            R"("rot_deg":{"rmse":null,"mean":null,"median":null,"std":null,"max":null}})");
}

TEST(MetricsJson, NamesTheFiguresOfAMap) {
  MapQuality quality;
  quality.voxels = 9;
  quality.sa = 1;
  quality.da = 2;
  quality.aa = 3;
  quality.ha = 4;
  quality.accuracy_m = 5;
  quality.completeness_m = 6;
  quality.ghosts = {.ratio = 7, .volume_l = 8, .clusters = 10};
  quality.off_ratio_5cm = 11;
  quality.off_ratio_10cm = 12;
  EXPECT_EQ(map_quality_json(quality).dump(),
            R"({"sa":1.0,"da":2.0,"aa":3.0,"ha":4.0,"accuracy_m":5.0,"completeness_m":6.0,)"
            R"("completeness_ratio":1.0,"ghost_ratio":7.0,"ghost_volume_l":8.0,)"
            R"("ghost_clusters":10,"off_ratio_5cm":11.0,"off_ratio_10cm":12.0,"voxels":9})");
  EXPECT_EQ(map_quality_json(std::nullopt).dump(),
            R"({"sa":null,"da":null,"aa":null,"ha":null,"accuracy_m":null,"completeness_m":null,)"
            R"("completeness_ratio":null,"ghost_ratio":null,"ghost_volume_l":null,)"
            R"("ghost_clusters":null,"off_ratio_5cm":null,"off_ratio_10cm":null,"voxels":null})");
}

TEST(MetricsJson, NamesTheResidue) {
  EXPECT_EQ(
      residue_json({.points = 8, .seen_through = 2, .by_noise = 1, .frames = 5}).dump(),
      R"({"ratio":0.25,"points":8,"noise_floor":0.125,"seen_through":2,"by_noise":1,"frames":5})");
  EXPECT_EQ(
      residue_json({.points = 0, .seen_through = 0, .frames = 5}).dump(),
      R"({"ratio":null,"points":0,"noise_floor":null,"seen_through":0,"by_noise":0,"frames":5})");
}

TEST(MetricsJson, GivesTheShareOfTrackedFrames) {
  EXPECT_EQ(frames_json(8, 6).dump(), R"({"total":8,"tracked":6,"ratio":0.75})");
  EXPECT_EQ(frames_json(0, 0).dump(), R"({"total":0,"tracked":0,"ratio":null})");
}

}  // namespace
}  // namespace stillmap
