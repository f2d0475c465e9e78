// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_tracker.hpp"

#include <cmath>
#include <map>
#include <memory>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "stillmap/perception/detections/box_overlap.hpp"
#include "stillmap/perception/objects/boxes.hpp"
#include "tests/support/dynamics_frames.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;

DepthImage flat_depth(float metres) {
  return DepthImage(cv::Mat1f(kHeight, kWidth, metres));
}

using ObservedFrame = ObjectTracker::Observation;

struct Seen {
  std::string class_name;
  PixelBox box;
};

/// Frame number `i` at 30 a second, its masks filling the boxes, 1 m away before a wall at 3 m.
ObservedFrame frame_of(std::uint32_t i, const std::vector<Seen>& seen, bool with_pixels = true) {
  ObservedFrame frame{FrameId(i), {}, flat_depth(3.0F)};
  frame.detections.stamp = {100.0 + i / 30.0, fmt::format("{:.6f}", 100.0 + i / 30.0)};
  frame.detections.mask = ObjectMask(cv::Mat1b(kHeight, kWidth, std::uint8_t{0}));
  int id = 7;  // not the position in the list
  for (const Seen& object : seen) {
    frame.detections.objects.push_back({id, object.class_name, 0.9F, object.box});
    const cv::Rect pixels = pixels_of(object.box, {kWidth, kHeight});
    if (with_pixels) frame.detections.mask.mat(pixels).setTo(id);
    frame.depth.mat(pixels).setTo(1.0F);
    id += 5;
  }
  return frame;
}

std::vector<FrameObjects> track_all(ObjectTracker tracker, std::vector<ObservedFrame> frames) {
  std::vector<FrameObjects> left;
  for (ObservedFrame& frame : frames) {
    std::optional<FrameObjects> out = tracker.push(std::move(frame));
    if (out) left.push_back(std::move(*out));
  }
  for (FrameObjects& out : tracker.flush()) left.push_back(std::move(out));
  return left;
}

PixelBox box_at(double x) {
  return {x, 10, x + 20, 50};
}

/// A person who walks 3 pixels a frame; missing in some frames.
std::vector<ObservedFrame> walker(std::size_t frames, const std::vector<std::uint32_t>& missing) {
  std::vector<ObservedFrame> result;
  for (std::uint32_t i = 0; i < frames; ++i) {
    const bool seen = std::ranges::find(missing, i) == missing.end();
    std::vector<Seen> objects;
    if (seen) objects.push_back({"person", box_at(3.0 * i)});
    result.push_back(frame_of(i, objects));
    // The person is there also when not detected.
    if (!seen) result.back().depth.mat(pixels_of(box_at(3.0 * i), {kWidth, kHeight})).setTo(1.0F);
  }
  return result;
}

TEST(BoxBetween, IsEquation10) {
  // One frame after (0, 10, 20, 30) and two before (30, 40, 80, 60): a third of the way.
  EXPECT_EQ(box_between({0, 10, 20, 30}, 1, {30, 40, 80, 60}, 2), (PixelBox{10, 20, 40, 40}));
  EXPECT_EQ(box_between({0, 0, 8, 8}, 3, {4, 4, 12, 12}, 1), (PixelBox{3, 3, 11, 11}));
}

TEST(Boxes, OverlapByHand) {
  EXPECT_DOUBLE_EQ(shared_area({0, 0, 4, 4}, {2, 1, 6, 3}), 4.0);
  EXPECT_DOUBLE_EQ(box_iou({0, 0, 4, 4}, {2, 1, 6, 3}), 4.0 / 20.0);
  EXPECT_EQ(box_iou({0, 0, 4, 4}, {4, 0, 8, 4}), 0.0);
  EXPECT_EQ(pixels_of({-3.5, 2.2, 5.1, 99}, {10, 8}), cv::Rect(0, 2, 6, 6));
  EXPECT_TRUE(pixels_of({20, 0, 30, 5}, {10, 8}).empty());
}

TEST(ObjectTracker, FramesLeaveThreeLaterOrAtOnce) {
  for (const FillRule rule : {FillRule::kBothWays, FillRule::kCausal}) {
    const std::size_t delay = rule == FillRule::kBothWays ? 3 : 0;
    ObjectTracker tracker({}, rule);
    for (std::uint32_t i = 0; i < 6; ++i) {
      const std::optional<FrameObjects> out = tracker.push(frame_of(i, {}));
      ASSERT_EQ(out.has_value(), i >= delay);
      if (i < delay) continue;
      EXPECT_EQ(out->frame, FrameId(i - static_cast<std::uint32_t>(delay)));
    }
    const std::vector<FrameObjects> rest = tracker.flush();
    ASSERT_EQ(rest.size(), delay);
    EXPECT_TRUE(rest.empty() || rest.back().frame == FrameId(5));
  }
}

TEST(ObjectTracker, IdentitiesStayAndMasksAreRenumbered) {
  std::vector<ObservedFrame> frames;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const Seen person{"person", box_at(10 + i)};
    const Seen chair{"chair", {40, 20, 60, 50}};
    // The order in the list changes from frame to frame.
    frames.push_back(i % 2 == 0 ? frame_of(i, {person, chair}) : frame_of(i, {chair, person}));
  }
  const std::vector<FrameObjects> out = track_all(ObjectTracker({}, FillRule::kBothWays), frames);
  ASSERT_EQ(out.size(), 6U);
  std::map<std::string, TrackId> track_of;
  for (const FrameObjects& frame : out) {
    ASSERT_EQ(frame.objects.size(), 2U);
    int number = 1;
    for (const TrackedObject& object : frame.objects) {
      EXPECT_EQ(object.detection.id, number++);
      EXPECT_FALSE(object.filled);
      const auto [known, is_new] = track_of.emplace(object.detection.class_name, object.track);
      EXPECT_EQ(known->second, object.track);
      const PixelBox& box = object.detection.box;
      EXPECT_EQ(frame.mask.mat(static_cast<int>(box.y0), static_cast<int>(box.x0)),
                object.detection.id);
    }
  }
  EXPECT_NE(track_of["person"], track_of["chair"]);
}

TEST(ObjectTracker, TwoWhoPassKeepTheirIdentityByTheirVelocity) {
  // They walk at +6 and -6 pixels a frame; in the frame after they meet, each box overlaps more
  // with where the other was last than with where it was itself.
  std::vector<ObservedFrame> frames;
  for (std::uint32_t i = 0; i < 9; ++i) {
    frames.push_back(frame_of(i,
                              {{"person", {6.0 * i, 10, 6.0 * i + 12, 50}},
                               {"person", {50 - 6.0 * i, 10, 62 - 6.0 * i, 50}}}));
  }
  const std::vector<FrameObjects> out = track_all(ObjectTracker({}, FillRule::kCausal), frames);
  for (const FrameObjects& frame : out) {
    ASSERT_EQ(frame.objects.size(), 2U);
    EXPECT_EQ(frame.objects[0].track, out[0].objects[0].track);
    EXPECT_EQ(frame.objects[1].track, out[0].objects[1].track);
  }
}

TEST(ObjectTracker, AGapIsInterpolatedAndSaysFromWhere) {
  const std::vector<FrameObjects> out =
      track_all(ObjectTracker({}, FillRule::kBothWays), walker(10, {4, 5}));
  ASSERT_EQ(out.size(), 10U);
  for (const std::size_t i : {4U, 5U}) {
    ASSERT_EQ(out[i].objects.size(), 1U);
    const TrackedObject& object = out[i].objects[0];
    EXPECT_EQ(object.filled, (BoxOrigin{FrameId(3), FrameId(6)}));
    EXPECT_EQ(object.track, out[0].objects[0].track);
    const PixelBox expected = box_at(3.0 * static_cast<double>(i));
    EXPECT_NEAR(object.detection.box.x0, expected.x0, 1e-9);
    EXPECT_NEAR(object.detection.box.x1, expected.x1, 1e-9);
    EXPECT_EQ(object.mask_source, MaskSource::kCarried);
    cv::Mat1b truth(kHeight, kWidth, std::uint8_t{0});
    truth(pixels_of(expected, truth.size())).setTo(1);
    EXPECT_EQ(cv::countNonZero(truth != (out[i].mask.mat > 0) / 255), 0);
  }
}

TEST(ObjectTracker, OnOneSideTheNearestBoxHoldsForThreeFrames) {
  ObjectTrackerConfig config;
  config.min_sightings = 1;  // three frames ahead of its first sighting there is but one
  const std::vector<FrameObjects> out = track_all(ObjectTracker(config, FillRule::kBothWays),
                                                  walker(14, {0, 1, 2, 3, 8, 9, 10, 11, 12, 13}));
  EXPECT_TRUE(out[0].objects.empty());
  for (const std::size_t i : {1U, 2U, 3U}) {
    ASSERT_EQ(out[i].objects.size(), 1U) << i;
    EXPECT_EQ(out[i].objects[0].filled, (BoxOrigin{std::nullopt, FrameId(4)}));
    EXPECT_EQ(out[i].objects[0].detection.box, box_at(12));
  }
  for (const std::size_t i : {8U, 9U, 10U}) {
    ASSERT_EQ(out[i].objects.size(), 1U) << i;
    EXPECT_EQ(out[i].objects[0].filled, (BoxOrigin{FrameId(7), std::nullopt}));
    EXPECT_EQ(out[i].objects[0].detection.box, box_at(21));
  }
  for (const std::size_t i : {11U, 12U, 13U}) EXPECT_TRUE(out[i].objects.empty()) << i;
}

TEST(ObjectTracker, CausalRuleGoesOnAtTheVelocityForThreeFrames) {
  const std::vector<FrameObjects> out =
      track_all(ObjectTracker({}, FillRule::kCausal), walker(12, {5, 6, 7, 8, 9, 10, 11}));
  for (const std::size_t i : {5U, 6U, 7U}) {
    ASSERT_EQ(out[i].objects.size(), 1U) << i;
    EXPECT_EQ(out[i].objects[0].filled, (BoxOrigin{FrameId(4), std::nullopt}));
    EXPECT_NEAR(out[i].objects[0].detection.box.x0, 3.0 * static_cast<double>(i), 1e-6);
  }
  EXPECT_TRUE(out[8].objects.empty());
}

// The network sees every third frame; in the others the box is where its velocity puts it.
TEST(ObjectTracker, CarriesToFramesThatNobodyLookedAt) {
  ObjectTracker tracker({}, FillRule::kCausal);
  const std::vector<ObservedFrame> frames = walker(12, {});
  EXPECT_TRUE(
      tracker.carry_to(FrameId(0), frames[0].detections.stamp, frames[0].depth).objects.empty());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 3 == 0) {
      (void)tracker.push(frames[i]);
      continue;
    }
    const FrameObjects carried =
        tracker.carry_to(frames[i].id, frames[i].detections.stamp, frames[i].depth);
    ASSERT_EQ(carried.objects.size(), 1U) << i;  // also when it was seen only once
    const TrackedObject& object = carried.objects[0];
    const auto looked_at = static_cast<std::uint32_t>(i - i % 3);
    EXPECT_EQ(object.filled, (BoxOrigin{FrameId(looked_at), std::nullopt}));
    if (i < 3) continue;  // at one sighting there is no velocity yet
    EXPECT_NEAR(object.detection.box.x0, 3.0 * static_cast<double>(i), 1e-6);
    cv::Mat1b truth(kHeight, kWidth, std::uint8_t{0});
    truth(pixels_of(box_at(3.0 * static_cast<double>(i)), truth.size())).setTo(1);
    EXPECT_EQ(cv::countNonZero(truth != (carried.mask.mat > 0) / 255), 0) << i;
  }
}

// An object that the network missed last is carried from its frame before, if seen twice.
TEST(ObjectTracker, CarriesWhatTheLastLookMissed) {
  ObjectTracker tracker({}, FillRule::kCausal);
  const std::vector<ObservedFrame> frames = walker(8, {6});
  for (const std::size_t i : {0U, 3U, 6U}) (void)tracker.push(frames[i]);
  const FrameObjects carried =
      tracker.carry_to(frames[7].id, frames[7].detections.stamp, frames[7].depth);
  ASSERT_EQ(carried.objects.size(), 1U);
  EXPECT_EQ(carried.objects[0].filled, (BoxOrigin{FrameId(3), std::nullopt}));
}

TEST(ObjectTracker, WhatWasSeenOnceIsFilledInOnlyWhenTold) {
  const std::vector<ObservedFrame> frames = walker(6, {0, 1, 3, 4, 5});
  const std::vector<FrameObjects> without =
      track_all(ObjectTracker({}, FillRule::kBothWays), frames);
  EXPECT_TRUE(without[3].objects.empty());
  ObjectTrackerConfig config;
  config.min_sightings = 1;
  const std::vector<FrameObjects> with =
      track_all(ObjectTracker(config, FillRule::kBothWays), frames);
  EXPECT_EQ(with[3].objects.size(), 1U);
}

TEST(ObjectTracker, ADifferentClassIsADifferentObject) {
  std::vector<ObservedFrame> frames;
  for (std::uint32_t i = 0; i < 4; ++i) {
    frames.push_back(frame_of(i, {{i < 2 ? "chair" : "couch", box_at(10)}}));
  }
  const std::vector<FrameObjects> out = track_all(ObjectTracker({}, FillRule::kCausal), frames);
  EXPECT_NE(out[1].objects[0].track, out[2].objects[0].track);
}

TEST(CarryMask, KeepsWhatFitsInDepthAndMovesAndScales) {
  // 10 x 10 pixels at 1 m become 20 x 20; the left half of these is now the wall.
  const DepthImage before = flat_depth(1.0F);
  const ObjectMask mask(cv::Mat1b(kHeight, kWidth, std::uint8_t{0}));
  mask.mat(cv::Rect(10, 10, 10, 10)).setTo(3);
  DepthImage now = flat_depth(1.1F);
  now.mat(cv::Rect(30, 20, 10, 20)).setTo(3.0F);
  now.mat(20, 45) = 0.0F;  // missing: does not contradict
  const ObjectView from{before, mask, 3, {10, 10, 20, 20}};
  const PropagatedMask carried =
      propagate_mask(from, mask_areas(mask)[3], {30, 20, 50, 40}, now, {});
  EXPECT_EQ(carried.source, MaskSource::kCarried);
  EXPECT_EQ(carried.patch.area, cv::Rect(30, 20, 20, 20));
  EXPECT_EQ(cv::countNonZero(carried.patch.pixels), 200);
  EXPECT_EQ(cv::countNonZero(carried.patch.pixels(cv::Rect(10, 0, 10, 20))), 200);
}

TEST(CarryMask, IsTheBoxWhereTooLittleFitsOrNothingWasThere) {
  const DepthImage before = flat_depth(1.0F);
  const ObjectMask mask(cv::Mat1b(kHeight, kWidth, std::uint8_t{0}));
  mask.mat(cv::Rect(10, 10, 10, 10)).setTo(3);
  const PixelBox box{12, 10, 22, 20};
  const PropagatedMask gone = propagate_mask(
      {before, mask, 3, {10, 10, 20, 20}}, mask_areas(mask)[3], box, flat_depth(3.0F), {});
  EXPECT_EQ(gone.source, MaskSource::kBox);
  EXPECT_EQ(cv::countNonZero(gone.patch.pixels), 100);
  const PropagatedMask no_pixels = propagate_mask(
      {before, mask, 4, {10, 10, 20, 20}}, mask_areas(mask)[4], box, flat_depth(1.0F), {});
  EXPECT_EQ(no_pixels.source, MaskSource::kBox);
}

TEST(ObjectTracker, FilledPixelsLeaveThoseOfOthersAlone) {
  std::vector<ObservedFrame> frames;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Seen chair{"chair", {20, 30, 60, 55}};
    const Seen person{"person", {10, 10, 40, 50}};
    frames.push_back(i == 2 ? frame_of(i, {chair}) : frame_of(i, {chair, person}));
    frames.back().depth.mat.setTo(1.0F);
  }
  const std::vector<FrameObjects> out = track_all(ObjectTracker({}, FillRule::kBothWays), frames);
  ASSERT_EQ(out[2].objects.size(), 2U);
  EXPECT_EQ(out[2].mask.mat(40, 30), 1);
  EXPECT_EQ(out[2].mask.mat(15, 15), 2);
}

bool is_dropped(std::size_t frame) {
  return frame % 7 == 3 || frame % 7 == 4;
}

std::vector<TruthSequence::Frame> truth_frames(const TruthSequence& data, std::uint32_t count) {
  std::vector<TruthSequence::Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) frames.push_back(data.truth(i));
  return frames;
}

/// The true boxes of people as detections without pixels, none in the dropped frames.
std::vector<ObservedFrame> detections_with_gaps(const TruthSequence& data,
                                                const std::vector<TruthSequence::Frame>& truth) {
  std::vector<ObservedFrame> frames(truth.size());
  for (std::uint32_t i = 0; i < truth.size(); ++i) {
    frames[i].id = FrameId(i);
    frames[i].detections.stamp = data.sequence().entry(FrameId(i)).stamp;
    frames[i].depth = DepthImage(cv::Mat1f(data.image(), 2.0F));
    if (is_dropped(i)) continue;
    for (const auto& [id, box] : truth[i].boxes) {
      if (id < 10) frames[i].detections.objects.push_back({id, "person", 1.0F, box});
    }
  }
  return frames;
}

struct FillScore {
  int boxes = 0, found = 0;
  double filled = 0;  // sums of overlaps
  double held = 0;    // for comparison: overlaps of the last detected box
};

FillScore score_fills(const std::vector<FrameObjects>& out,
                      const std::vector<TruthSequence::Frame>& truth) {
  FillScore score;
  for (std::size_t i = 7; i < out.size(); ++i) {
    if (!is_dropped(i)) continue;
    for (const auto& [id, box] : truth[i].boxes) {
      if (id >= 10) continue;
      double best = 0;
      for (const TrackedObject& object : out[i].objects) {
        best = std::max(best, box_iou(object.detection.box, box));
      }
      ++score.boxes;
      score.filled += best;
      score.found += best > 0.5 ? 1 : 0;
      for (const auto& [other, old] : truth[i - (i % 7 - 2)].boxes) {
        if (other == id) score.held += box_iou(old, box);
      }
    }
  }
  return score;
}

// The true boxes, with two of every seven frames removed.
TEST(ObjectTracker, FillsTheBoxesOfPeopleOnTruth) {
  for (const char* name : {"twin_walking_xyz", "fr1_xyz_walkers"}) {
    STILLMAP_NEED_SHARED_DATA(name);
    const TruthSequence data(shared_data(name));
    const std::vector<TruthSequence::Frame> truth = truth_frames(data, 150);
    for (const FillRule rule : {FillRule::kBothWays, FillRule::kCausal}) {
      const FillScore score =
          score_fills(track_all(ObjectTracker({}, rule), detections_with_gaps(data, truth)), truth);
      const std::string what =
          fmt::format("{} {}: {} boxes, {} found, mean IoU {:.3f}, held {:.3f}",
                      name,
                      rule == FillRule::kBothWays ? "both ways" : "causal",
                      score.boxes,
                      score.found,
                      score.filled / score.boxes,
                      score.held / score.boxes);
      SCOPED_TRACE(what);
      RecordProperty("fills", what);
      fmt::print("{}\n", what);
      ASSERT_GT(score.boxes, 20);
      EXPECT_GT(score.filled / score.boxes,
                rule == FillRule::kCausal ? 0.8 : 0.88);  // without filling it is 0
      EXPECT_GT(score.found, (rule == FillRule::kCausal ? 0.85 : 0.92) * score.boxes);
      EXPECT_GT(score.filled, score.held);
    }
  }
}

}  // namespace
}  // namespace stillmap
