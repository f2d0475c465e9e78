// SPDX-License-Identifier: Apache-2.0
// The effect of each stage of the dynamics: without it, the same frames give a worse trajectory.
// Each is tested on the fault that it is made for, against which no other stage helps.
#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/system.hpp"
#include "tests/support/feature_images.hpp"
#include "tests/support/rendered_room.hpp"
#include "tooling/eval/ate.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kEnters = 10;  // frame in which the curtain appears
constexpr int kCurtainEnd = 150;       // the columns left of it are never covered
constexpr int kFrayedBegin = 170;      // column from which depth is wrong
constexpr float kCurtain_m = 1.0F;     // nearer than anything in the room

/// The first column that a curtain covers, which comes in from the right.
int curtain_begin(std::uint32_t k) {
  const int columns = 10 * (static_cast<int>(k) - static_cast<int>(kEnters));
  return std::clamp(320 - columns, kCurtainEnd, 320);
}

/// The disturbance that the frames show in front of the room.
enum class Disturbance {
  kNone,
  kCurtain,  ///< covers most of the room and moves up and down, which can mislead tracking
  kFrayed,   ///< half of the room seems nearer than it is, each pixel differently
};

void draw_curtain(RgbdFrame& frame) {
  static const GrayImage kPattern = textured_image(320, 400, 2);
  const std::uint32_t k = frame.id.value;
  const int begin = curtain_begin(k);
  if (begin == 320) return;
  const cv::Rect covered(begin, 0, 320 - begin, 240);
  const int top = std::abs(static_cast<int>(k * 5 % 240) - 120);  // five pixels a frame
  kPattern.mat(covered + cv::Point(0, top)).copyTo(frame.gray.mat(covered));
  TestDice dice(k);
  for (float& z : cv::Mat1f(frame.depth.mat, covered)) z = kCurtain_m + dice.uniform(-0.01F, 0.01F);
}

void fray_depth(RgbdFrame& frame) {
  TestDice dice(frame.id.value);
  for (int v = 0; v < 240; ++v) {
    for (int u = kFrayedBegin; u < 320; ++u) {
      float& z = frame.depth.mat(v, u);
      if (z > 0) z *= dice.uniform(0.5F, 0.9F);
    }
  }
}

FramePtr disturbed(const RgbdFrame& room, Disturbance disturbance) {
  RgbdFrame frame = room;
  frame.gray = GrayImage(room.gray.mat.clone());
  frame.depth = DepthImage(room.depth.mat.clone());
  if (disturbance == Disturbance::kCurtain) draw_curtain(frame);
  if (disturbance == Disturbance::kFrayed) fray_depth(frame);
  return std::make_shared<const RgbdFrame>(std::move(frame));
}

/// The detections of a network in frame k.
using Network = std::function<FrameDetections(std::uint32_t k)>;

FrameDetections empty_frame(std::uint32_t k) {
  FrameDetections found;
  found.stamp = empty_room().sequence().stamp(FrameId(k));
  found.mask = ObjectMask(cv::Mat1b(240, 320, std::uint8_t{0}));
  return found;
}

/// Adds an object from column `begin` to `end` - 1, whose mask ends at `mask_end`.
void add_object(FrameDetections& found, const char* name, int begin, int end, int mask_end) {
  if (end - begin < 10) return;
  const int id = static_cast<int>(found.objects.size()) + 1;
  found.objects.push_back({static_cast<std::uint8_t>(id),
                           name,
                           1.0,
                           {static_cast<double>(begin), 0, static_cast<double>(end), 240}});
  cv::Mat1b mask = found.mask.mat.colRange(begin, std::clamp(mask_end, begin, end));
  mask.setTo(id);
}

FrameDetections whole_curtain(std::uint32_t k) {
  FrameDetections found = empty_frame(k);
  add_object(found, "person", curtain_begin(k), 320, 320);
  return found;
}

RunResult run(Disturbance disturbance, const Network& network, const SystemConfig& config) {
  ObjectTracker tracker(config.dynamics.object_tracking(), FillRule::kBothWays);
  System system(config, empty_room().camera(), {.threads = 1});
  std::vector<FramePtr> frames;
  const auto process = [&](FrameObjects objects) {
    const FramePtr frame = frames.at(objects.frame.value);
    (void)system.process(frame, std::move(objects));
  };
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
    frames.push_back(disturbed(*empty_room().frame(k), disturbance));
    if (auto objects = tracker.push({FrameId(k), network(k), frames[k]->depth})) {
      process(std::move(*objects));
    }
  }
  for (FrameObjects& objects : tracker.flush()) process(std::move(objects));
  return system.finish();
}

/// The error in metres plus the share of frames without a pose (all frames lost: 1 m).
double error(Disturbance disturbance, const Network& network, const SystemConfig& config) {
  Trajectory truth;
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
    truth.push_back({empty_room().sequence().stamp(FrameId(k)), empty_room().pose(k)});
  }
  const Trajectory trajectory = run(disturbance, network, config).trajectory;
  const std::optional<AteResult> ate = absolute_trajectory_error(truth, trajectory);
  const double lost = static_cast<double>(kRoomFrames - trajectory.size()) / kRoomFrames;
  return lost + (ate ? ate->translation_m.rmse : 1.0);
}

/// A mode with only the named ones of its stages.
SystemConfig with_stages(const std::string& mode, std::initializer_list<std::string> stages) {
  SystemConfig config;
  config.dynamics.mode = mode;
  config.tracking.smooth = false;  // it would hide a part of the errors
  config.tracking.tracker.enough_inliers = 0;
  config.dynamics.motion.standing_frames = 100000;
  config.dynamics.tracker.masks_from_depth = false;
  for (const std::string stage : {"extension.enabled",
                                  "jump.enabled",
                                  "interaction.enabled",
                                  "fill_boxes",
                                  "depth_stability.enabled",
                                  "static_matches.enabled"}) {
    const bool wanted = std::ranges::find(stages, stage) != stages.end();
    set_value(list_fields(config), fmt::format("dynamics.{}={}", stage, wanted));
  }
  config.dynamics.features.depth_stability.in_full = true;
  return config;
}

struct Comparison {
  double with = 0, without = 0;
};

Comparison compare(Disturbance disturbance,
                   const Network& network,
                   const std::string& mode,
                   const std::string& stage) {
  const Comparison errors{error(disturbance, network, with_stages(mode, {stage})),
                          error(disturbance, network, with_stages(mode, {}))};
  fmt::print("{}: {:.4f} m with {}, {:.4f} m without\n", mode, errors.with, stage, errors.without);
  return errors;
}

void expect_gain(Disturbance disturbance,
                 const Network& network,
                 const std::string& mode,
                 const std::string& stage,
                 double gain = 1.6) {
  const Comparison errors = compare(disturbance, network, mode, stage);
  EXPECT_LT(errors.with, 0.02);
  EXPECT_GT(errors.without, gain * errors.with);
}

TEST(Stages, MasksKeepTheCurtainOutOfThePose) {
  EXPECT_LT(error(Disturbance::kCurtain, whole_curtain, with_stages("mask", {})), 0.02);
  EXPECT_GT(error(Disturbance::kCurtain, empty_frame, with_stages("mask", {})), 0.04);
}

/// A network that masks only the left of the curtain.
Network half_blind(double masked_share) {
  return [masked_share](std::uint32_t k) {
    const int begin = curtain_begin(k);
    FrameDetections found = empty_frame(k);
    add_object(found, "person", begin, 320, begin + cvRound(masked_share * (320 - begin)));
    return found;
  };
}

TEST(Stages, ExtensionReachesWhereMasksDoNot) {
  expect_gain(Disturbance::kCurtain, half_blind(0.5), "paper", "extension.enabled");
  expect_gain(Disturbance::kCurtain, half_blind(0.7), "full", "extension.enabled");
}

TEST(Stages, JumpsFindWhatNoNetworkDoes) {
  expect_gain(Disturbance::kCurtain, empty_frame, "full", "jump.enabled");
}

TEST(Stages, InteractionFindsWhatAPersonMoves) {
  const Network network = [](std::uint32_t k) {
    const int begin = curtain_begin(k);
    FrameDetections found = empty_frame(k);
    const int person_end = std::min(begin + 40, 320);
    add_object(found, "person", begin, person_end, person_end);
    if (begin < 240) add_object(found, "chair", begin + 30, 320, 320);
    return found;
  };
  for (const char* mode : {"paper", "full"})
    expect_gain(Disturbance::kCurtain, network, mode, "interaction.enabled");
}

TEST(Stages, FilledBoxesStandForThoseMissed) {
  const Network network = [](std::uint32_t k) {
    return k % 4 == 0 || k % 4 == 1 ? empty_frame(k) : whole_curtain(k);
  };
#ifdef __clang__
  constexpr double kGain = 1.3;  // it rounds otherwise than GCC: 1.4 to 1.5
#else
  constexpr double kGain = 1.6;  // 1.9 to 2.2
#endif
  for (const char* mode : {"paper", "full"})
    expect_gain(Disturbance::kCurtain, network, mode, "fill_boxes", kGain);
}

// Features without a match in the previous frame are not judged: the pose is better, not right. The
// curtain moves along many epipolar lines, so that the letter of the article gains little here: a
// twentieth. With the test of the motion, by depth, much is gained.
TEST(Stages, StaticMatchesTellWhatMovesInABoxWithoutMask) {
  const auto error_with = [](std::initializer_list<std::string> stages) {
    SystemConfig config = with_stages("paper", stages);
    config.dynamics.features.static_matches.motion_check = true;
    return error(Disturbance::kCurtain, half_blind(0), config);
  };
  const Comparison errors{error_with({"static_matches.enabled"}), error_with({})};
  EXPECT_GT(errors.without, 1.3 * errors.with);
}

TEST(Stages, StableDepthIsBetterThanAny) {
  for (const char* mode : {"paper", "full"})
    expect_gain(Disturbance::kFrayed, empty_frame, mode, "depth_stability.enabled");
}

// A false person, fixed in the image, covers four fifths of it, after a while or from the first
// frame on: no stage but the pose may suffer.
TEST(Stages, DoubtKeepsTheCameraBehindAFalseMask) {
  for (const std::uint32_t first : {20U, 0U}) {
    const Network network = [=](std::uint32_t k) {
      FrameDetections found = empty_frame(k);
      if (k >= first) add_object(found, "person", 0, 256, 256);
      for (DetectedObject& object : found.objects) object.score = 0.3F;
      return found;
    };
    SystemConfig config = with_stages("full", {});
    const double without = error(Disturbance::kNone, network, config);
    config.tracking.tracker = {};
    config.dynamics.motion = {};
    const double with = error(Disturbance::kNone, network, config);
    fmt::print("from {}: {:.4f} m with doubt, {:.4f} m without\n", first, with, without);
    EXPECT_LT(with, 0.01);
    EXPECT_GT(without, 2 * with);
  }
}

// A curtain walks in like a person, and the network misses it for a third of a second now and then.
TEST(Stages, MissedPeopleLeaveNothingInTheMap) {
  const Network network = [](std::uint32_t k) {
    return k < 15 || k % 20 < 11 ? empty_frame(k) : whole_curtain(k);
  };
  const auto ghosts = [&](const char* missed_people) {
    SystemConfig config = with_stages("full", {});
    config.cloud.free_space = "off";  // here it would find them, too: later views see the room
    config.cloud.missed_people = missed_people;
    const PointCloud map = run(Disturbance::kCurtain, network, config).map;
    return std::ranges::count_if(
        map.positions, [](const Eigen::Vector3f& p) { return p.z() < kCurtain_m + 0.1F; });
  };
  const auto with = ghosts("on"), without = ghosts("off");
  fmt::print("full: {} points of the curtain, {} without\n", with, without);
  EXPECT_GT(without, 1000);
  EXPECT_LT(with, without / 20);
}

}  // namespace
}  // namespace stillmap
