// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/mask_extension.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace stillmap {
namespace {

const cv::Size kImage(160, 120);
constexpr int kId = 4;
const PixelBox kBox{40, 10, 100, 110};

/// A person before a wall at 3 m: a trunk at 2 m, and an arm held out to the right and forward,
/// which the mask lacks.
struct Scene {
  DepthImage depth{cv::Mat1f(kImage, 3.0F)};
  ObjectMask mask{cv::Mat1b(kImage, std::uint8_t{0})};
  cv::Rect trunk{50, 20, 30, 80};
  cv::Rect arm{80, 40, 16, 10};

  Scene() {
    for (int x = trunk.x; x < trunk.x + trunk.width; ++x) {  // round
      const float bulge = 0.15F * static_cast<float>(std::abs(x - 65)) / 15.0F;
      depth.mat(cv::Rect(x, trunk.y, 1, trunk.height)).setTo(2.0F + bulge);
    }
    for (int x = arm.x; x < arm.x + arm.width; ++x) {
      depth.mat(cv::Rect(x, arm.y, 1, arm.height))
          .setTo(2.15F - 0.004F * static_cast<float>(x - arm.x));
    }
    mask.mat(trunk).setTo(kId);
  }

  [[nodiscard]] PixelPatch extended(const MaskExtensionConfig& config,
                                    const HalfDepth& known_static = {}) const {
    const MaskArea area = mask_areas(mask)[kId];
    const ObjectDepths depths = object_depths(depth, mask, kId, area, outlier_rule(config));
    return extend_mask({depth, mask, kId, kBox}, area, depths, config, known_static);
  }
};

MaskExtensionConfig paper(int whole_box_px = 0) {
  MaskExtensionConfig config;
  config.variant = "paper";
  config.whole_box_px = whole_box_px;
  return config;
}

bool has(const PixelPatch& patch, int x, int y) {
  return patch.area.contains({x, y}) && patch.pixels(y - patch.area.y, x - patch.area.x) != 0;
}

/// The number of a patch's pixels in a rectangle.
int pixels_in(const PixelPatch& patch, const cv::Rect& where) {
  int count = 0;
  for (int y = where.y; y < where.y + where.height; ++y) {
    for (int x = where.x; x < where.x + where.width; ++x) count += has(patch, x, y) ? 1 : 0;
  }
  return count;
}

TEST(ObjectDepths, MedianAndIntervalByHand) {
  // 1.9 2.0 2.0 2.1 2.3 8.0: the lower median 2.0, distances 0 0 .1 .1 .3 6: the lower median 0.1.
  // Outliers are farther than 3 x 0.148 = 0.44.
  DepthImage depth(cv::Mat1f(1, 8, 0.0F));
  ObjectMask mask(cv::Mat1b(1, 8, std::uint8_t{9}));
  const std::vector<float> values{2.0F, 8.0F, 1.9F, 2.1F, 0.0F, 2.3F, 2.0F, 5.0F};
  std::ranges::copy(values, depth.mat[0]);
  mask.mat(0, 7) = 3;  // another's
  const MaskArea area = mask_areas(mask)[9];
  EXPECT_EQ(area.pixels, 7U);
  EXPECT_EQ(area.bounds, cv::Rect(0, 0, 7, 1));
  const ObjectDepths found = object_depths(depth, mask, 9, area, {});
  EXPECT_EQ(found.measured, 6U);
  EXPECT_NEAR(static_cast<double>(found.median_m), 2.0, 0.001);
  EXPECT_NEAR(static_cast<double>(found.mad_m), 0.1, 0.0011);
  ASSERT_TRUE(found.interval);
  EXPECT_EQ(found.interval->min_m, 1.9F);
  EXPECT_EQ(found.interval->max_m, 2.3F);
}

TEST(ObjectDepths, NothingMeasuredIsNoInterval) {
  const DepthImage depth(cv::Mat1f(4, 4, 0.0F));
  const ObjectMask mask(cv::Mat1b(4, 4, std::uint8_t{1}));
  EXPECT_FALSE(object_depths(depth, mask, 1, mask_areas(mask)[1], {}).interval);
  EXPECT_FALSE(object_depths(depth, mask, 2, mask_areas(mask)[2], {}).interval);
}

TEST(MaskAreas, OfRandomIdsEqualThoseCountedOneByOne) {
  ObjectMask mask(cv::Mat1b(37, 53));
  cv::RNG rng(5);
  rng.fill(mask.mat, cv::RNG::UNIFORM, 0, 4);
  mask.mat(cv::Rect(7, 3, 30, 20)).setTo(0);
  const MaskAreas areas = mask_areas(mask);
  for (int id = 1; id < 6; ++id) {
    const MaskArea& area = areas[static_cast<std::size_t>(id)];
    EXPECT_EQ(area.pixels, static_cast<std::size_t>(cv::countNonZero(mask.mat == id)));
    cv::Mat1b outside = (mask.mat == id);
    EXPECT_EQ(area.bounds.area() > 0, area.pixels > 0);
    outside(area.bounds).setTo(0);
    EXPECT_EQ(cv::countNonZero(outside), 0);
  }
  EXPECT_EQ(areas[0].pixels, 0U);
}

TEST(PaperExtension, PixelsOfTheBoxStrictlyWithinTheDepthsJoin) {
  Scene scene;
  scene.depth.mat(60, 90) = 2.05F;   // in the box, within
  scene.depth.mat(61, 90) = 2.0F;    // L itself: not within
  scene.depth.mat(62, 90) = 2.16F;   // beyond U
  scene.depth.mat(60, 110) = 2.05F;  // within, but out of the box
  const PixelPatch patch = scene.extended(paper());
  EXPECT_TRUE(has(patch, 90, 60));
  EXPECT_FALSE(has(patch, 90, 61));
  EXPECT_FALSE(has(patch, 90, 62));
  EXPECT_FALSE(has(patch, 110, 60));
  EXPECT_EQ(pixels_in(patch, scene.trunk), scene.trunk.area());
  EXPECT_GE(pixels_in(patch, scene.arm), scene.arm.area() - 10);  // its first column is at U
}

TEST(PaperExtension, TheWholeBoxStandsInForASmallMask) {
  const Scene scene;  // 2400 of 160 x 120 pixels: 38400 of 640 x 480
  const cv::Rect box(40, 10, 60, 100);
  EXPECT_EQ(pixels_in(scene.extended(paper(38401)), box), box.area());
  EXPECT_LT(pixels_in(scene.extended(paper(38400)), box), box.area());
}

TEST(ConnectedExtension, AMissingArmJoinsAndTheWallDoesNot) {
  const Scene scene;
  MaskExtensionConfig config;
  config.grow_px = 80;  // a quarter of it here
  const PixelPatch patch = scene.extended(config);
  EXPECT_EQ(pixels_in(patch, scene.trunk), scene.trunk.area());
  EXPECT_EQ(pixels_in(patch, scene.arm), scene.arm.area());
  EXPECT_EQ(pixels_in(patch, patch.area), scene.trunk.area() + scene.arm.area());
}

TEST(ConnectedExtension, AnArmReachesBeyondTheBox) {
  Scene scene;
  const cv::Rect hand(96, 40, 8, 10);  // the box ends at 100
  scene.depth.mat(hand).setTo(2.086F);
  MaskExtensionConfig config;
  config.grow_px = 200;
  EXPECT_EQ(pixels_in(scene.extended(config), hand), hand.area());
  EXPECT_LE(pixels_in(scene.extended(paper()), hand), 40);
}

TEST(ConnectedExtension, ReachesTheBorderOfImagesOfAnySize) {
  for (const cv::Size size :
       {cv::Size(80, 60), cv::Size(81, 60), cv::Size(80, 61), cv::Size(81, 61)}) {
    for (const cv::Point corner : {cv::Point(50, 30), cv::Point(48, 32)}) {
      const cv::Rect whole(corner, cv::Point(size.width, size.height));
      DepthImage depth(cv::Mat1f(size, 3.0F));
      depth.mat(whole).setTo(1.5F);
      ObjectMask mask(cv::Mat1b(size, std::uint8_t{0}));
      mask.mat(cv::Rect(whole.x, whole.y, whole.width - 7, whole.height - 5)).setTo(kId);
      MaskExtensionConfig config;
      config.grow_px = 400;  // of an image 640 wide
      const MaskArea area = mask_areas(mask)[kId];
      const ObjectDepths depths = object_depths(depth, mask, kId, area, outlier_rule(config));
      const PixelBox box{static_cast<double>(whole.x),
                         static_cast<double>(whole.y),
                         static_cast<double>(size.width),
                         static_cast<double>(size.height)};
      const PixelPatch patch = extend_mask({depth, mask, kId, box}, area, depths, config, {});
      EXPECT_EQ(pixels_in(patch, whole), whole.area()) << size << corner;
      EXPECT_EQ(cv::countNonZero(patch.pixels), whole.area()) << size << corner;
    }
  }
}

TEST(ConnectedExtension, SomethingApartAtTheSameDepthStaysStatic) {
  Scene scene;
  const cv::Rect box_on_a_table(84, 70, 12, 20);  // four pixels of wall between
  scene.depth.mat(box_on_a_table).setTo(2.05F);
  EXPECT_EQ(pixels_in(scene.extended({}), box_on_a_table), 0);
  EXPECT_EQ(pixels_in(scene.extended(paper()), box_on_a_table), box_on_a_table.area());
}

TEST(ConnectedExtension, WhatIsSomebodyElsesDoesNotJoin) {
  Scene scene;
  scene.mask.mat(scene.arm).setTo(kId + 1);
  EXPECT_EQ(pixels_in(scene.extended({}), scene.arm), 0);
}

TEST(ConnectedExtension, WhatIsKnownToStandStillDoesNotJoin) {
  // A shelf touches the trunk at the trunk's depth; it was there before the person.
  const Scene scene;
  cv::Mat1f known(60, 80, 0.0F);
  for (int row = 0; row < known.rows; ++row) {
    for (int c = 0; c < known.cols; ++c) {
      if (scene.arm.contains({2 * c, 2 * row})) known(row, c) = scene.depth.mat(2 * row, 2 * c);
    }
  }
  MaskExtensionConfig config;
  config.grow_px = 80;
  EXPECT_EQ(pixels_in(scene.extended(config), scene.arm), scene.arm.area());
  EXPECT_EQ(pixels_in(scene.extended(config, HalfDepth(known)), scene.arm), 0);
  known += 0.1F;  // another surface was there
  EXPECT_EQ(pixels_in(scene.extended(config, HalfDepth(known)), scene.arm), scene.arm.area());
}

TEST(ConnectedExtension, ALeakOntoTheWallLeavesTheMaskWhenAsked) {
  Scene scene;
  const cv::Rect leak(44, 30, 6, 8);  // 2 % of the mask, at the wall's depth
  scene.mask.mat(leak).setTo(kId);
  MaskExtensionConfig config;
  config.drop_outliers = true;
  EXPECT_EQ(pixels_in(scene.extended(config), leak), 0);
  config.drop_outliers = false;
  EXPECT_EQ(pixels_in(scene.extended(config), leak), leak.area());
}

TEST(ConnectedExtension, ALargePartAtAnotherDepthStays) {
  Scene scene;
  const cv::Rect other(80, 50, 15, 40);  // a fifth of the mask, half a metre nearer
  scene.mask.mat(other).setTo(kId);
  scene.depth.mat(other).setTo(1.4F);
  EXPECT_EQ(pixels_in(scene.extended({}), other), other.area());
}

TEST(ConnectedExtension, AHoleWithoutDepthInsideIsFilled) {
  Scene scene;
  const cv::Rect hole(56, 40, 14, 12);
  scene.depth.mat(hole).setTo(0.0F);
  scene.mask.mat(hole).setTo(0);
  const cv::Rect beside(110, 40, 14, 12);  // one in the wall
  scene.depth.mat(beside).setTo(0.0F);
  const PixelPatch patch = scene.extended({});
  EXPECT_EQ(pixels_in(patch, hole), hole.area());
  EXPECT_EQ(pixels_in(patch, beside), 0);
}

TEST(ConnectedExtension, SomethingInsideThatIsAnothersIsNoHole) {
  Scene scene;
  const cv::Rect phone(58, 44, 10, 12);
  scene.mask.mat(phone).setTo(kId + 1);
  EXPECT_EQ(pixels_in(scene.extended({}), phone), 0);
}

TEST(ConnectedExtension, ASmallMaskOnALargeSurfaceDoesNotGrow) {
  // A false person on the wall: growth from it would be mostly wall.
  Scene scene;
  scene.mask.mat.setTo(0);
  const cv::Rect speck(120, 50, 8, 8);
  scene.mask.mat(speck).setTo(kId);
  const MaskArea area = mask_areas(scene.mask)[kId];
  const ObjectDepths depths = object_depths(scene.depth, scene.mask, kId, area, outlier_rule({}));
  const PixelPatch patch =
      extend_mask({scene.depth, scene.mask, kId, {110, 40, 140, 70}}, area, depths, {});
  EXPECT_EQ(pixels_in(patch, patch.area), speck.area());
}

TEST(ConnectedExtension, WithoutDepthTheMaskIsKept) {
  Scene scene;
  scene.depth.mat.setTo(0.0F);
  const PixelPatch patch = scene.extended({});
  EXPECT_EQ(pixels_in(patch, cv::Rect({0, 0}, kImage)), scene.trunk.area());
}

TEST(MaskExtension, ABoxOutsideTheImageHarmsNothing) {
  const Scene scene;
  const PixelBox outside{500, 500, 600, 600};
  for (const char* variant : {"paper", "connected"}) {
    MaskExtensionConfig config;
    config.variant = variant;
    for (const int id : {kId, kId + 1}) {  // with pixels elsewhere, and without any
      const MaskArea area = mask_areas(scene.mask)[static_cast<std::size_t>(id)];
      const ObjectDepths depths =
          object_depths(scene.depth, scene.mask, id, area, outlier_rule(config));
      const PixelPatch patch =
          extend_mask({scene.depth, scene.mask, id, outside}, area, depths, config);
      EXPECT_EQ(patch.area & cv::Rect({0, 0}, kImage), patch.area);
      EXPECT_GE(pixels_in(patch, patch.area), static_cast<int>(area.pixels));
    }
  }
}

TEST(ConnectedExtension, OfNoMaskIsNothing) {
  Scene scene;
  scene.mask.mat.setTo(0);
  EXPECT_TRUE(scene.extended({}).area.empty());
}

}  // namespace
}  // namespace stillmap
