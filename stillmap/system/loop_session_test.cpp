// SPDX-License-Identifier: Apache-2.0
// One round through a rendered office: loops, submaps, and sessions that are saved, continued and
// merged.
#include <atomic>
#include <chrono>
#include <future>

#include <gtest/gtest.h>

#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/system.hpp"
#include "tests/support/files.hpp"
#include "tests/support/rendered_room.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/statistics.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kRound = 600;  // frames; the beginning is seen again after it
constexpr std::uint32_t kEnd = 660;

const RenderedRoom& office() {
  static const RenderedRoom kOffice(kEnd, PathKind::kLoop);
  return kOffice;
}

SystemConfig loop_settings(bool loops = true) {
  SystemConfig config;
  config.dynamics.mode = "off";
  config.loop.enabled = loops;
  config.relocalization.new_world_after_frames = 10;
  return config;
}

// Every second frame: 15 a second.
void process(System& system, std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t k = begin; k < end; k += 2) (void)system.process(office().frame(k));
}

void cover(System& system, std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t k = begin; k < end; k += 2) {
    EXPECT_EQ(system.process(office().dark_frame(k)).status, TrackingStatus::kLost);
  }
}

double error_m(const Trajectory& trajectory) {
  const std::optional<AteResult> ate =
      absolute_trajectory_error(office().sequence().ground_truth(), trajectory);
  return ate ? ate->translation_m.rmse : std::numeric_limits<double>::infinity();
}

Session saved(System& system) {
  Session session = system.take_session();
  SystemConfig config = loop_settings();
  session.config_yaml = dump_yaml(list_fields(config));
  return decode_session(encode_session(session), "map.stillmap");
}

struct Round {
  RunResult result;
  Session session;
};

Round run(std::uint32_t begin,
          std::uint32_t end,
          bool loops = true,
          const SystemOptions& options = {.threads = 2}) {
  System system(loop_settings(loops), office().camera(), options);
  process(system, begin, end);
  Round round{system.finish(), {}};
  system.map().check_consistency();
  round.session = saved(system);
  return round;
}

const Round& closed_round() {
  static const Round kClosed = run(0, kEnd, true, {.threads = 1});
  return kClosed;
}

TEST(LoopClosing, TakesTheDriftOfARoundAway) {
  const Round open = run(0, kEnd, false);
  const Round& closed = closed_round();
  ASSERT_EQ(closed.result.trajectory.size(), kEnd / 2);
  EXPECT_TRUE(open.result.loops.empty());
  ASSERT_FALSE(closed.result.loops.empty());
  for (const ClosedLoop& loop : closed.result.loops) {
    EXPECT_GT(loop.later.seconds - loop.earlier.seconds, 15.0);
  }
  EXPECT_LT(error_m(closed.result.trajectory), 0.035);
  EXPECT_LT(error_m(closed.result.trajectory), 0.7 * error_m(open.result.trajectory));
}

TEST(LoopClosing, GivesTheSameBitsWithAnyNumberOfThreadsHoweverSlow) {
  std::atomic<int> adjustments = 0;
  const auto slow = [&](Stage stage) {
    if (stage != Stage::kAdjustment) return;
    ++adjustments;
    (void)std::promise<void>().get_future().wait_for(std::chrono::seconds(2));  // not set by anyone
  };
  const Round& one = closed_round();
  const Round four = run(0, kEnd, true, {.threads = 4, .probe = slow});
  EXPECT_GT(adjustments, 0);
  ASSERT_FALSE(one.result.loops.empty());
  EXPECT_EQ(one.result.map.positions, four.result.map.positions);
  EXPECT_EQ(encode_session(one.session), encode_session(four.session));
}

TEST(LoopClosing, HandsAnErrorOfTheAdjustmentOn) {
  const auto broken = [](Stage stage) {
    if (stage == Stage::kAdjustment) throw Error("the adjustment is broken");
  };
  EXPECT_EQ(error_of([&] { (void)run(0, kEnd, true, {.threads = 2, .probe = broken}); }),
            "the adjustment is broken");
}

TEST(SavedSession, IsTrackedAgainstWithOtherFrames) {
  const Round before = run(0, 160);
  System system(loop_settings(), office().camera(), {.threads = 2, .localize_only = true});
  system.load(before.session);
  std::vector<double> errors_m;
  for (std::uint32_t k = 41; k < 160; k += 2) {
    const FrameResult tracked = system.process(office().frame(k));
    ASSERT_TRUE(has_pose(tracked)) << k;
    EXPECT_EQ(tracked.status == TrackingStatus::kRelocalized, k == 41) << k;
    // The previous pose, of the saved session, and the true motion since; nothing is aligned.
    const Eigen::Isometry3d T_before_this = office().pose(k - 1).inverse() * office().pose(k);
    const Eigen::Isometry3d expected =
        before.result.trajectory[k / 2].T_world_camera * T_before_this;
    errors_m.push_back((tracked.T_world_camera.translation() - expected.translation()).norm());
  }
  EXPECT_LT(statistics(errors_m).rmse, 0.025);
  const RunResult result = system.finish();
  EXPECT_EQ(result.trajectory.size(), 60U);
  EXPECT_EQ(result.map.positions, before.result.map.positions);
  EXPECT_EQ(result.keyframes.size(), before.result.keyframes.size());
}

TEST(SavedSession, IsGoneOnFrom) {
  const Round before = run(0, 120);
  System system(loop_settings(), office().camera(), {.threads = 2});
  system.load(before.session);
  process(system, 101, 200);
  const RunResult result = system.finish();
  system.map().check_consistency();
  EXPECT_EQ(result.trajectory.size(), 50U);
  EXPECT_EQ(result.trajectory.front().stamp.text, office().frame(101)->stamp.text);
  EXPECT_GT(result.keyframes.size(), before.result.keyframes.size());
  EXPECT_GT(result.map.size(), before.result.map.size());
  EXPECT_LT(error_m(result.trajectory), 0.05);
  const Session session = saved(system);
  EXPECT_EQ(session.map.submaps().size(), 1U);
  EXPECT_EQ(session.frames.size(), 60U + 50U);
}

TEST(SavedSession, RefusesAnotherCamera) {
  const Round before = run(0, 20);
  System system(loop_settings(), synthetic_camera(640, 480), {.threads = 1});
  EXPECT_THROW(system.load(before.session), Error);
}

TEST(MergedSessions, AreOneRoom) {
  const Round first = run(0, 360), second = run(300, 560);
  const std::optional<MergedSessions> merged =
      merge_sessions(first.session, second.session, "second");
  ASSERT_TRUE(merged);
  EXPECT_GE(merged->loops, 1U);
  merged->session.map.check_consistency();
  EXPECT_EQ(merged->session.map.submaps().size(), 1U);
  const SubmapId world = main_submap(merged->session);
  const Trajectory older = trajectory_in(merged->session, world, 0);
  ASSERT_EQ(older.size(), 180U + 130U);
  // Both halves have poses of the frames that they share; together they form one trajectory.
  Trajectory all(older.begin(), older.begin() + 180);
  for (const StampedPose& pose : trajectory_in(merged->session, world, 180)) {
    if (pose.stamp.seconds > all.back().stamp.seconds) all.push_back(pose);
  }
  EXPECT_EQ(all.size(), 280U);
  EXPECT_LT(error_m(all), 0.06);
}

TEST(MergedSessions, OfPlacesThatHaveNothingInCommonAreNone) {
  const Round first = run(0, 100), second = run(300, 400);
  EXPECT_FALSE(merge_sessions(first.session, second.session, "second"));
}

// After the camera was covered for long, it continues at an unknown place, in a new submap.
TEST(Worlds, AreJoinedWhenAKnownPlaceIsSeenAgain) {
  System system(loop_settings(), office().camera(), {.threads = 2});
  process(system, 0, 120);
  cover(system, 120, 150);
  process(system, 400, kEnd);
  const RunResult result = system.finish();
  system.map().check_consistency();
  EXPECT_EQ(result.frames_elsewhere, 0U);
  EXPECT_EQ(result.trajectory.size(), 60U + 130U);
  EXPECT_EQ(result.loops.size(), 1U);
  EXPECT_EQ(system.map().submaps().size(), 1U);
  EXPECT_LT(error_m(result.trajectory), 0.04);
}

TEST(Worlds, StayApartWithoutOne) {
  System system(loop_settings(), office().camera(), {.threads = 1});
  process(system, 0, 120);
  cover(system, 120, 150);
  process(system, 300, 360);
  const RunResult result = system.finish();
  EXPECT_EQ(result.frames_elsewhere, 30U);
  EXPECT_EQ(result.trajectory.size(), 60U);  // of the submap with most frames
  EXPECT_TRUE(result.loops.empty());
  EXPECT_EQ(system.map().submaps().size(), 2U);
}

}  // namespace
}  // namespace stillmap
