// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/box_mask.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace stillmap {
namespace {

const cv::Rect kThing(250, 150, 120, 150);
const PixelBox kBox{248, 149, 372, 302};

/// A room with a wall at 4 m and a floor that comes nearer below, and an object at 2 m on the
/// floor: at its foot, floor and object have the same depth.
DepthImage room_with_thing() {
  DepthImage depth(cv::Mat1f(480, 640, 4.0F));
  for (int row = 200; row < 480; ++row) {
    depth.mat.row(row).setTo(std::min(4.0F, 200.0F / static_cast<float>(row - 200)));
  }
  cv::Mat1f(depth.mat, kThing).setTo(2.0F);
  return depth;
}

double overlap(const PixelPatch& patch, const cv::Rect& truth) {
  cv::Mat1b found(480, 640, std::uint8_t{0}), expected(480, 640, std::uint8_t{0});
  if (!patch.area.empty()) cv::Mat1b(patch.pixels != 0).copyTo(found(patch.area));
  expected(truth).setTo(255);
  return static_cast<double>(cv::countNonZero(found & expected)) /
         cv::countNonZero(found | expected);
}

TEST(MaskFromDepth, IsTheThingWithoutWallAndFloor) {
  EXPECT_GT(overlap(mask_from_depth(room_with_thing(), {}, kBox), kThing), 0.9);
}

TEST(MaskFromDepth, OfALooseBoxIsTheThingToo) {
  const PixelBox loose{230, 130, 400, 330};
  EXPECT_GT(overlap(mask_from_depth(room_with_thing(), {}, loose), kThing), 0.85);
}

// The back of a chair, and its seat, which begins nearer and lies below an arm.
TEST(MaskFromDepth, HasPartsThatOnlyTheBoxTiesTogether) {
  DepthImage depth = room_with_thing();
  cv::Mat1f(depth.mat, cv::Rect(250, 240, 120, 60)).setTo(1.7F);
  cv::Mat1f(depth.mat, cv::Rect(250, 232, 120, 8)).setTo(1.5F);
  EXPECT_GT(overlap(mask_from_depth(depth, {}, kBox), kThing), 0.85);
}

TEST(MaskFromDepth, LeavesOutWhatIsBehindAndBefore) {
  DepthImage depth = room_with_thing();
  const cv::Rect pole(300, 0, 16, 480);  // a person's leg passes before it
  cv::Mat1f(depth.mat, pole).setTo(0.8F);
  const PixelPatch patch = mask_from_depth(depth, {}, kBox);
  const cv::Mat1b on_pole =
      patch.pixels(cv::Rect(pole.x - patch.area.x + 4, 0, 8, patch.area.height));
  EXPECT_EQ(cv::countNonZero(on_pole), 0);
  EXPECT_GT(overlap(patch, kThing), 0.75);  // the leg hides an eighth of it
}

TEST(MaskFromDepth, FollowsTheLayerThatTheObjectHadBefore) {
  DepthImage depth = room_with_thing();
  cv::Mat1f(depth.mat, cv::Rect(250, 150, 60, 150)).setTo(1.2F);  // as large, and nearer
  const cv::Rect nearer(250, 150, 60, 150), farther(310, 150, 60, 150);
  EXPECT_GT(overlap(mask_from_depth(depth, {}, kBox), nearer), 0.8);
  EXPECT_GT(overlap(mask_from_depth(depth, {}, kBox, 2.0F), farther), 0.8);
}

TEST(MaskFromDepth, TakesNoPixelFromOthers) {
  ObjectMask mask(cv::Mat1b(480, 640, std::uint8_t{0}));
  mask.mat(cv::Rect(250, 150, 30, 150)).setTo(7);
  const PixelPatch patch = mask_from_depth(room_with_thing(), mask, kBox);
  EXPECT_GT(overlap(patch, {280, 150, 90, 150}), 0.85);
  EXPECT_LT(overlap(patch, {250, 150, 30, 150}), 0.01);
}

TEST(MaskFromDepth, IsEmptyWithoutDepthOrForABoxTooSmall) {
  const DepthImage dark(cv::Mat1f(480, 640, 0.0F));
  EXPECT_EQ(overlap(mask_from_depth(dark, {}, kBox), kThing), 0);
  EXPECT_TRUE(mask_from_depth(room_with_thing(), {}, {300, 200, 310, 210}).area.empty());
  EXPECT_TRUE(mask_from_depth(room_with_thing(), {}, {-500, -500, -10, -10}).area.empty());
  EXPECT_TRUE(mask_from_depth(room_with_thing(), {}, {0, 0, 1e9, 1e-9}).area.empty());
  const DepthImage broken(cv::Mat1f(480, 640, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(overlap(mask_from_depth(broken, {}, kBox), kThing), 0);
}

DetectedObject with_rough_mask(int id, float score) {
  return {id, "person", score, kBox, PixelSource::kRoughNetwork};
}

double overlap_of_refined(const DepthImage& depth, cv::Rect rough) {
  ObjectMask mask(cv::Mat1b(480, 640, std::uint8_t{0}));
  mask.mat(rough).setTo(5);
  return overlap(mask_refined_by_depth(depth, mask, with_rough_mask(5, 0.9F)), kThing);
}

// The network sees the whole box as a person: the wall beside the thing leaves the mask.
TEST(MaskRefinedByDepth, LosesTheBackground) {
  const DepthImage depth = room_with_thing();
  EXPECT_GT(overlap_of_refined(depth, {245, 140, 130, 165}), 0.9);
}

// The network misses the upper half, a back in a shirt of the wall's color.
TEST(MaskRefinedByDepth, GainsWhatTheNetworkMissed) {
  const DepthImage depth = room_with_thing();
  EXPECT_GT(overlap_of_refined(depth, {255, 230, 110, 60}), 0.85);  // the rough mask has 0.37
}

TEST(MaskRefinedByDepth, KeepsPixelsWithoutDepthAndIsEmptyWithoutAny) {
  DepthImage depth = room_with_thing();
  const cv::Rect unmeasured(270, 170, 40, 30);
  cv::Mat1f(depth.mat, unmeasured).setTo(0.0F);
  EXPECT_GT(overlap_of_refined(depth, kThing), 0.95);
  depth.mat.setTo(0.0F);
  EXPECT_EQ(overlap_of_refined(depth, kThing), 0);
}

// The network takes the floor beside the thing for a part of it. Depth has no step there, but the
// floor goes on beyond the box.
TEST(MaskRefinedByDepth, LosesAFloorThatGoesOn) {
  const DepthImage depth = room_with_thing();
  ObjectMask mask(cv::Mat1b(480, 640, std::uint8_t{0}));
  const cv::Rect rough(240, 140, 230, 220);
  mask.mat(rough).setTo(5);
  DetectedObject object = with_rough_mask(5, 0.9F);
  object.box = {240, 140, 470, 360};
  EXPECT_GT(overlap(mask_refined_by_depth(depth, mask, object), kThing), 0.8);
}

// A back has no step to the floor behind it either, goes on beyond a box that is too small, but is
// round.
TEST(MaskRefinedByDepth, KeepsWhatIsRound) {
  DepthImage depth = room_with_thing();
  for (int x = kThing.x; x < kThing.br().x; ++x) {
    const float off = static_cast<float>(x - kThing.x) / static_cast<float>(kThing.width) - 0.5F;
    cv::Mat1f(depth.mat, cv::Rect(x, kThing.y, 1, kThing.height)).setTo(1.9F + 0.6F * off * off);
  }
  ObjectMask mask(cv::Mat1b(480, 640, std::uint8_t{0}));
  mask.mat(kThing).setTo(5);
  DetectedObject object = with_rough_mask(5, 0.9F);
  object.box.y1 = 270;
  const PixelPatch patch = mask_refined_by_depth(depth, mask, object);
  const cv::Rect in_box(kThing.x, kThing.y, kThing.width, 270 - kThing.y);
  EXPECT_GT(cv::countNonZero(patch.pixels(in_box - patch.area.tl())), 0.9 * in_box.area());
}

// A person's mask covers a part of the chair before the person: the chair, a box alone, gets it.
TEST(CompleteMasks, RefinedMasksLeavePixelsToBoxesAlone) {
  DepthImage depth = room_with_thing();
  const cv::Rect chair(210, 230, 90, 70);
  cv::Mat1f(depth.mat, chair).setTo(1.2F);
  FrameDetections found;
  found.objects = {{1, "chair", 0.8F, {208, 228, 302, 302}}, with_rough_mask(2, 0.5F)};
  found.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  found.mask.mat(kThing).setTo(2);
  (void)complete_masks(found, depth, {std::nullopt, std::nullopt});
  EXPECT_GT(cv::countNonZero(found.mask.mat(chair) == 1), 0.8 * chair.area());
  EXPECT_GT(cv::countNonZero(found.mask.mat == 2), 0.8 * (kThing.area() - (kThing & chair).area()));
  EXPECT_EQ(found.objects[0].pixel_source, PixelSource::kDepth);
  EXPECT_EQ(found.objects[1].pixel_source, PixelSource::kNetwork) << "it is not refined again";
  const cv::Mat1b before = found.mask.mat;
  (void)complete_masks(found, depth, {std::nullopt, std::nullopt});
  EXPECT_EQ(cv::countNonZero(before != found.mask.mat), 0);
}

// A box of somebody far away lies in that of somebody near, who got all pixels but an edge.
TEST(CompleteMasks, PixelsOfSomebodyBehindGoToTheBoxThere) {
  DepthImage depth = room_with_thing();
  const cv::Rect far(260, 60, 80, 85);
  cv::Mat1f(depth.mat, far).setTo(3.2F);
  FrameDetections found;
  found.objects = {with_rough_mask(1, 0.9F), with_rough_mask(2, 0.5F)};
  found.objects[0].box = {248, 58, 372, 302};
  found.objects[1].box = {258, 58, 342, 147};
  found.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  found.mask.mat(kThing).setTo(1);
  found.mask.mat(cv::Rect(258, 56, 84, 6)).setTo(2);
  found.mask.mat(far).setTo(1);
  (void)complete_masks(found, depth, {std::nullopt, std::nullopt});
  EXPECT_GT(cv::countNonZero(found.mask.mat(kThing) == 1), 0.9 * kThing.area());
  EXPECT_GT(cv::countNonZero(found.mask.mat(far) == 2), 0.9 * far.area());
}

TEST(CompleteMasks, ABoxOutsideTheImageGetsNoPixels) {
  FrameDetections found;
  found.objects = {with_rough_mask(1, 0.9F), with_rough_mask(2, 0.5F)};
  found.objects[1].box = {-500, -500, -10, -10};
  found.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  found.mask.mat(cv::Rect(240, 60, 140, 240)).setTo(1);  // with the wall above
  (void)complete_masks(found, room_with_thing(), {std::nullopt, std::nullopt});
  EXPECT_EQ(cv::countNonZero(found.mask.mat == 2), 0);
  EXPECT_GT(cv::countNonZero(found.mask.mat == 1), 0.9 * kThing.area());
}

TEST(CompleteMasks, GivesPixelsToBoxesAloneTheSurestFirst) {
  FrameDetections found;
  const PixelBox other{20, 20, 80, 80};
  found.objects = {{1, "cup", 0.3F, kBox}, {2, "chair", 0.8F, kBox}, {3, "person", 0.9F, other}};
  found.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  found.mask.mat(cv::Rect(20, 20, 60, 60)).setTo(3);
  const cv::Mat1b given = found.mask.mat;
  const std::vector<bool> completed =
      complete_masks(found, room_with_thing(), {std::nullopt, std::nullopt, std::nullopt});
  EXPECT_TRUE(completed[1]);
  EXPECT_FALSE(completed[2]);
  EXPECT_GT(cv::countNonZero(found.mask.mat == 2), 0.9 * kThing.area());
  EXPECT_LT(cv::countNonZero(found.mask.mat == 1), 0.1 * kThing.area());
  EXPECT_EQ(cv::countNonZero(found.mask.mat == 3), 60 * 60);
  EXPECT_EQ(cv::countNonZero(given == 2), 0) << "the image that was given is another's";
}

}  // namespace
}  // namespace stillmap
