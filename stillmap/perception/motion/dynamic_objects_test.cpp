// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/dynamic_objects.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/perception/objects/object_tracker.hpp"
#include "tests/support/dynamics_frames.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

/// A person at 2 m, three chairs (at 2 m and at 3 m, both with boxes that meet the person's, and
/// one far aside), and a table.
struct Office {
  DepthImage depth{cv::Mat1f(480, 640, 5.0F)};
  FrameObjects objects;

  Office() {
    objects.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
    add("person", {200, 50, 300, 400}, 2.0F);
    add("chair", {300, 250, 400, 400}, 2.1F);
    add("chair", {150, 250, 200, 400}, 3.0F);
    add("chair", {500, 250, 600, 400}, 2.0F);
    add("dining table", {250, 400, 350, 470}, 2.0F);
    // The boxes overlap.
    objects.objects[1].detection.box.x0 = 280;
    objects.objects[2].detection.box.x1 = 220;
  }

  void add(const std::string& name, const PixelBox& box, float metres) {
    const int id = static_cast<int>(objects.objects.size()) + 1;
    objects.objects.push_back(tracked_object(name, box, id));
    const cv::Rect pixels(cv::Point2d(box.x0, box.y0), cv::Point2d(box.x1, box.y1));
    objects.mask.mat(pixels).setTo(id);
    for (int row = 0; row < pixels.height; ++row) {  // it leans back, by 30 cm
      const float lean = 0.3F * static_cast<float>(row) / static_cast<float>(pixels.height) - 0.15F;
      depth.mat(pixels).row(row).setTo(metres + lean);
    }
  }

  [[nodiscard]] DynamicsResult judge(const DynamicsMode& mode,
                                     std::span<const TrackId> moving = {}) const {
    return DynamicObjects({}, builtin_camera("tum_fr3"), mode)
        .judge(depth, objects, {}, {.moving = moving});
  }
};

// A person's mask on a wall: depth does not show where the person ends.
TEST(DynamicObjects, AMaskDoesNotGrowBeyondTheSizeOfItsClass) {
  Office office;
  office.depth.mat.setTo(2.5F);
  office.objects.objects.resize(1);
  office.objects.mask.mat.setTo(0);
  office.objects.mask.mat(cv::Rect(200, 50, 260, 400)).setTo(1);  // 1.2 m by 1.9 m
  office.objects.objects[0].detection.box = {200, 50, 460, 450};
  DynamicObjectsConfig config;
  const auto extended = [&] {
    const DynamicObjects objects(config, builtin_camera("tum_fr3"), dynamics_mode("full"));
    return cv::countNonZero(objects.judge(office.depth, office.objects, {}).mask.extended.mat);
  };
  EXPECT_EQ(extended(), 260 * 400);
  config.extension.bounded = false;
  EXPECT_GT(extended(), 1.2 * 260 * 400);
}

std::vector<StateReason> reasons(const DynamicsResult& result) {
  std::vector<StateReason> found;
  for (const ObjectState& state : result.states) found.push_back(state.reason);
  return found;
}

// A network that gives only boxes: without masks by depth, overlap would be possible contact.
TEST(DynamicObjects, BoxesAloneAreJudgedByTheirDepth) {
  for (const bool by_depth : {true, false}) {
    const Office office;
    FrameDetections boxes;
    boxes.stamp.seconds = 1;
    for (const TrackedObject& object : office.objects.objects) {
      boxes.objects.push_back(object.detection);
    }
    ObjectTrackerConfig tracking;
    tracking.masks_from_depth = by_depth;
    ObjectTracker tracker(tracking, FillRule::kCausal);
    const FrameObjects found = tracker.push({FrameId(0), boxes, office.depth}).value();
    EXPECT_EQ(found.objects[1].mask_source, by_depth ? MaskSource::kDepth : MaskSource::kDetected);
    const std::vector<StateReason> judged =
        reasons(DynamicObjects({}, builtin_camera("tum_fr3"), dynamics_mode("full"))
                    .judge(office.depth, found, {}));
    EXPECT_EQ(judged[1], by_depth ? StateReason::kTouching : StateReason::kDepthUnknown);
    EXPECT_EQ(judged[2], by_depth ? StateReason::kDepthsApart : StateReason::kDepthUnknown);
  }
}

TEST(DynamicObjects, JudgesEachObjectWithAReason) {
  const Office office;
  const DynamicsResult result = office.judge(dynamics_mode("paper"));
  EXPECT_EQ(reasons(result),
            (std::vector<StateReason>{StateReason::kDynamicClass,
                                      StateReason::kTouching,
                                      StateReason::kDepthsApart,
                                      StateReason::kBoxesApart,
                                      StateReason::kStaticClass}));
  EXPECT_TRUE(result.states[0].dynamic && result.states[1].dynamic);
  EXPECT_FALSE(result.states[2].dynamic || result.states[3].dynamic || result.states[4].dynamic);
  EXPECT_EQ(result.states[1].person, TrackId(1));
  EXPECT_EQ(result.states[2].person, TrackId(1));
  EXPECT_FALSE(result.states[3].person);
  EXPECT_EQ(result.mask.raw.mat(100, 250), 1);
  EXPECT_EQ(result.mask.raw.mat(300, 350), 2);
  EXPECT_EQ(result.mask.raw.mat(300, 170), 0);
  EXPECT_TRUE(result.mask.covers(300, 350));
  EXPECT_FALSE(result.mask.covers(300, 550));
}

TEST(DynamicObjects, MaskModeTakesPeopleAsTheNetworkHasThem) {
  const DynamicsResult result = Office().judge(dynamics_mode("mask"));
  EXPECT_EQ(reasons(result),
            (std::vector<StateReason>{StateReason::kDynamicClass,
                                      StateReason::kNotAsked,
                                      StateReason::kNotAsked,
                                      StateReason::kNotAsked,
                                      StateReason::kStaticClass}));
  EXPECT_EQ(cv::countNonZero(result.mask.extended.mat != result.mask.raw.mat), 0);
  EXPECT_EQ(cv::countNonZero(result.mask.raw.mat), 100 * 350);
}

// The chair that the person touches.
TEST(DynamicObjects, WhatRestsKeepsItsMaskAndDoesNotMove) {
  Office office;
  office.objects.mask.mat(cv::Rect(300, 250, 100, 20)).setTo(0);  // cut off by the network
  const auto judge = [&](const char* mode, const std::vector<TrackId>& standing) {
    return DynamicObjects({}, builtin_camera("tum_fr3"), dynamics_mode(mode))
        .judge(office.depth, office.objects, {}, {.standing = standing});
  };
  const std::vector<TrackId> all{TrackId(1), TrackId(2)};  // people sway
  const DynamicsResult moves = judge("full", {}), rests = judge("full", all);
  EXPECT_TRUE(moves.states[1].dynamic && rests.states[1].dynamic);
  EXPECT_EQ(moves.mask.extended.mat(265, 350), 2);
  EXPECT_EQ(rests.mask.extended.mat(265, 350), 0) << "may be the person's";
  EXPECT_TRUE(moves.mask.moving().covers(320, 350));
  EXPECT_FALSE(rests.mask.moving().covers(320, 350));
  EXPECT_TRUE(rests.mask.all().covers(320, 350));
  EXPECT_TRUE(rests.mask.moving().covers(200, 250)) << "the person";
  EXPECT_TRUE(judge("paper", all).mask.moving().covers(320, 350));
}

TEST(DynamicObjects, WhatHasBeenSeenToMoveIsDynamicInFullAlone) {
  const std::vector<TrackId> moving{TrackId(4), TrackId(5)};
  const DynamicsResult full = Office().judge(dynamics_mode("full"), moving);
  EXPECT_EQ(full.states[3].reason, StateReason::kMoving);
  EXPECT_TRUE(full.states[3].dynamic && full.states[4].dynamic);
  EXPECT_EQ(full.mask.raw.mat(300, 550), 4);
  EXPECT_FALSE(Office().judge(dynamics_mode("paper"), moving).states[3].dynamic);
}

TEST(DynamicObjects, ABoxInPlaceOfAMaskIsTakenWhole) {
  Office office;
  office.objects.objects[0].mask_source = MaskSource::kBox;
  office.depth.mat(cv::Rect(200, 50, 100, 150)).setTo(5.0F);  // half of it is wall
  const DynamicsResult result = office.judge(dynamics_mode("full"));
  EXPECT_EQ(cv::countNonZero(result.mask.extended.mat == 1), 100 * 350);
}

// Fan 2020 has no other masks than the network's: Eq. (5) takes the whole box of a tracked object.
TEST(DynamicObjects, PaperTakesTheBoxOfAnObjectThatTheNetworkMissed) {
  for (const MaskSource source : {MaskSource::kCarried, MaskSource::kBox, MaskSource::kDepth}) {
    Office office;
    office.objects.objects.resize(2);
    office.objects.objects[0].mask_source = source;
    // The chair, which is dynamic, and hides a part of the box, is in the box, too.
    office.objects.mask.mat(cv::Rect(200, 50, 50, 350)).setTo(0);
    office.objects.mask.mat(cv::Rect(280, 250, 20, 150)).setTo(2);
    const DynamicsResult result = office.judge(dynamics_mode("paper"));
    EXPECT_EQ(cv::countNonZero(result.mask.extended.mat(cv::Rect(200, 50, 100, 350))), 100 * 350);
  }
}

TEST(DynamicObjects, AnEmptyFrameHasNothing) {
  const DepthImage depth(cv::Mat1f(480, 640, 2.0F));
  const DynamicsResult result =
      DynamicObjects({}, builtin_camera("tum_fr3"), dynamics_mode("full"))
          .judge(depth, {}, std::array{PreviousDepth{depth, Eigen::Isometry3d::Identity()}});
  EXPECT_TRUE(result.states.empty());
  EXPECT_EQ(cv::countNonZero(result.mask.all().mat | result.mask.raw.mat), 0);
}

TEST(DynamicObjects, GarbageInTheDepthHarmsNothing) {
  Office office;
  cv::RNG rng(3);
  const std::vector<float> garbage{std::nanf(""), -1.0F, INFINITY, -INFINITY, 1e30F, 1e-30F, 0.0F};
  for (float& z : office.depth.mat) {
    if (rng.uniform(0, 3) == 0) z = garbage[static_cast<std::size_t>(rng.uniform(0, 7))];
  }
  const std::array before{PreviousDepth{office.depth, Eigen::Isometry3d::Identity()}};
  for (const char* mode : {"paper", "full"}) {
    const DynamicsResult result = DynamicObjects({}, builtin_camera("tum_fr3"), dynamics_mode(mode))
                                      .judge(office.depth, office.objects, before);
    EXPECT_EQ(result.states[0].reason, StateReason::kDynamicClass);
    EXPECT_GE(cv::countNonZero(result.mask.extended.mat == 1), 100 * 350);
    EXPECT_EQ(cv::countNonZero(result.mask.jumps.mat & ~(office.depth.mat > 0)), 0);
  }
}

// --- on truth -----------------------------------------------------------------------------------

struct Result {
  Coverage raw, extended, all;
  std::vector<double> ms;

  [[nodiscard]] double median_ms() const {
    std::vector<double> sorted = ms;
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  }
};

/// A frame of a sequence with its tracked objects.
struct SequenceFrame {
  FramePtr frame;
  FrameObjects objects;
};

SequenceFrame frame_with_objects(const TruthSequence& data, std::uint32_t index) {
  ObjectTracker tracker({}, FillRule::kCausal);
  const FramePtr before = data.sequence().read(FrameId(index - 1));
  const FramePtr frame = data.sequence().read(FrameId(index));
  (void)tracker.push({before->id, data.detections(index - 1), before->depth});
  return {frame, *tracker.push({frame->id, data.detections(index), frame->depth})};
}

/// The pixels that a mode covers in every ninth frame of a sequence, at true poses.
Result run_on(const TruthSequence& data, const DynamicsMode& mode) {
  const Sequence& sequence = data.sequence();
  const Trajectory poses = sequence.groundtruth().value().poses;
  const DynamicObjects dynamics({}, sequence.camera(), mode);
  const std::uint32_t back = mode.jumps == JumpRule::kWarpedFrames ? 15 : 1;
  Result result;
  for (std::uint32_t i = 16; i < sequence.size(); i += 9) {
    const auto [old, old_objects] = frame_with_objects(data, i - back);
    const auto [frame, objects] = frame_with_objects(data, i);
    const std::array before{PreviousDepth{
        old->depth,
        pose_at(poses, frame->stamp.seconds).inverse() * pose_at(poses, old->stamp.seconds),
        Mask(dynamics.judge(old->depth, old_objects, {}).mask.extended.mat)}};
    const auto begin = std::chrono::steady_clock::now();
    const DynamicsResult judged = dynamics.judge(frame->depth, objects, before);
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - begin;
    result.ms.push_back(spent.count());
    const TruthSequence::Frame truth = data.truth(i);
    result.raw.add(judged.mask.raw.mat, truth);
    result.extended.add(judged.mask.extended.mat, truth);
    result.all.add(judged.mask.all().mat, truth);
  }
  return result;
}

void print(const char* what, const Result& result) {
  const auto line = [](const Coverage& c) {
    return fmt::format(
        "IoU {:.3f} recall {:.3f} wrong {:.4f}", c.iou(), c.recall(), c.wrong_share());
  };
  fmt::print("{}: raw {}; extended {}; with jumps {}; {:.2f} ms\n",
             what,
             line(result.raw),
             line(result.extended),
             line(result.all),
             result.median_ms());
}

TEST(DynamicObjects, CoverWhatMovesOnTruth) {
  for (const char* name : {"twin_walking_xyz", "fr1_xyz_walkers"}) {
    STILLMAP_NEED_SHARED_DATA(name);
    const TruthSequence data(shared_data(name));
    SCOPED_TRACE(name);
    const Result mask = run_on(data, dynamics_mode("mask"));
    const Result paper = run_on(data, dynamics_mode("paper"));
    const Result full = run_on(data, dynamics_mode("full"));
    fmt::print("{}\n", name);
    print("  mask", mask);
    print("  paper", paper);
    print("  full", full);
    // Each stage finds more of the moving pixels.
    EXPECT_GT(paper.extended.recall(), paper.raw.recall());
    EXPECT_GT(paper.all.recall(), paper.extended.recall());
    EXPECT_GT(full.extended.recall(), full.raw.recall());
    EXPECT_GT(full.all.recall(), full.extended.recall());
    // `full` finds more than `paper` and covers fewer static pixels.
    EXPECT_GT(full.all.recall(), mask.all.recall() + 0.015);
    EXPECT_GT(full.all.recall(), paper.all.recall());
    EXPECT_LT(full.all.wrong_share(), 0.85 * paper.all.wrong_share());
    EXPECT_GT(full.extended.iou(), paper.extended.iou());
    EXPECT_GT(full.all.iou(), paper.all.iou());
  }
}

}  // namespace
}  // namespace stillmap
