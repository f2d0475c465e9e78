// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/system.hpp"

#include <set>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulation/synth/detection_faults.hpp"
#include "simulation/synth/sequence.hpp"
#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "tests/support/rendered_room.hpp"
#include "tooling/eval/ate.hpp"

namespace stillmap {
namespace {

SystemConfig static_world() {
  SystemConfig config;
  config.dynamics.mode = "off";
  return config;
}

struct FinishedRun {
  std::vector<FrameResult> frames;
  RunResult result;
};

// Runs the frames; those from `dark_begin` to `dark_end` - 1 are dark.
FinishedRun run(int threads,
                std::uint32_t dark_begin = kRoomFrames,
                std::uint32_t dark_end = kRoomFrames) {
  System system(static_world(), synthetic_camera(320, 240), {.threads = threads});
  FinishedRun done;
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
    const bool dark = k >= dark_begin && k < dark_end;
    done.frames.push_back(
        system.process(dark ? empty_room().dark_frame(k) : empty_room().frame(k)));
    system.map().check_consistency();
  }
  done.result = system.finish();
  system.map().check_consistency();
  return done;
}

void expect_equal(const Trajectory& a, const Trajectory& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp.text, b[i].stamp.text);
    EXPECT_EQ(a[i].T_world_camera.matrix(), b[i].T_world_camera.matrix()) << i;
  }
}

TEST(System, FollowsARenderedCameraAndMapsItsRoom) {
  const FinishedRun done = run(1);
  ASSERT_EQ(done.result.trajectory.size(), kRoomFrames);
  EXPECT_FALSE(done.result.lost_at_end);
  EXPECT_EQ(done.frames[0].status, TrackingStatus::kInitialized);
  EXPECT_TRUE(done.frames[0].is_keyframe);
  const std::optional<AteResult> ate =
      absolute_trajectory_error(empty_room().sequence().ground_truth(), done.result.trajectory);
  ASSERT_TRUE(ate);
  EXPECT_EQ(ate->pairs.size(), kRoomFrames);
  EXPECT_LT(ate->translation_m.rmse, 0.006);
  EXPECT_GT(done.result.keyframes.size(), 2U);
  EXPECT_LT(done.result.keyframes.size(), kRoomFrames / 3);
  EXPECT_GT(done.result.map.size(), 10000U);
  // The world frame is that of the first camera, and stamps are those of the frames.
  EXPECT_TRUE(
      done.result.trajectory[0].T_world_camera.isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
    EXPECT_EQ(done.result.trajectory[k].stamp.text, empty_room().sequence().stamp(FrameId(k)).text);
  }
}

TEST(System, ASmoothTrajectoryIsNearerToTheTruth) {
  const auto error_m = [](bool smooth) {
    SystemConfig config = static_world();
    config.tracking.smooth = smooth;
    System system(config, empty_room().camera(), {.threads = 1});
    for (std::uint32_t k = 0; k < kRoomFrames; ++k) (void)system.process(empty_room().frame(k));
    const Trajectory trajectory = system.finish().trajectory;
    return absolute_trajectory_error(empty_room().sequence().ground_truth(), trajectory)
        .value()
        .translation_m.rmse;
  };
  const double rough = error_m(false), smooth = error_m(true);
  fmt::print("{:.4f} m as tracked, {:.4f} m smoothed\n", rough, smooth);
  EXPECT_LT(smooth, 0.9 * rough);
}

TEST(System, GivesTheSameBitsWithAnyNumberOfThreads) {
  const FinishedRun one = run(1), two = run(2), again = run(2);
  for (const FinishedRun* other : {&two, &again}) {
    expect_equal(one.result.trajectory, other->result.trajectory);
    expect_equal(one.result.keyframes, other->result.keyframes);
    EXPECT_EQ(one.result.map.positions, other->result.map.positions);
    EXPECT_EQ(one.result.map.colors, other->result.map.colors);
    for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
      EXPECT_EQ(one.frames[k].is_keyframe, other->frames[k].is_keyframe);
      EXPECT_EQ(one.frames[k].tracked_features, other->frames[k].tracked_features);
      EXPECT_EQ(one.frames[k].T_world_camera.matrix(), other->frames[k].T_world_camera.matrix());
    }
  }
}

// Moved by whole voxels, so that points stay together; a point on the face between two may change.
TEST(System, MakesItsCloudAgainUnderOtherPoses) {
  System system(static_world(), synthetic_camera(320, 240), {.threads = 1});
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) (void)system.process(empty_room().frame(k));
  const RunResult result = system.finish();
  std::vector<std::optional<Eigen::Isometry3d>> same, moved;
  for (const StampedPose& pose : result.trajectory) {
    same.emplace_back(pose.T_world_camera);
    moved.emplace_back(Eigen::Translation3d(0.64, 0, 0) * pose.T_world_camera);
  }
  EXPECT_EQ(system.map_with_poses(same).positions, result.map.positions);
  const PointCloud other = system.map_with_poses(moved);
  const auto mean_x = [](const PointCloud& cloud) {
    double sum = 0;
    for (const Eigen::Vector3f& p : cloud.positions) sum += static_cast<double>(p.x());
    return sum / static_cast<double>(cloud.size());
  };
  EXPECT_NEAR(mean_x(other), mean_x(result.map) + 0.64, 0.005);

  for (std::size_t i = 1; i < same.size(); ++i) same[i].reset();
  const PointCloud first_only = system.map_with_poses(same);
  EXPECT_GT(first_only.size(), 1000U);
  EXPECT_LT(first_only.size(), result.map.size());
}

TEST(System, MarksDarkFramesAsLostAndFindsBack) {
  const FinishedRun done = run(2, 35, 45);
  for (std::uint32_t k = 0; k < kRoomFrames; ++k) {
    const bool dark = k >= 35 && k < 45;
    EXPECT_EQ(has_pose(done.frames[k]), !dark) << k;
  }
  EXPECT_EQ(done.frames[45].status, TrackingStatus::kRelocalized);
  EXPECT_EQ(done.result.trajectory.size(), kRoomFrames - 10);
  EXPECT_FALSE(done.result.lost_at_end);
  const std::optional<AteResult> ate =
      absolute_trajectory_error(empty_room().sequence().ground_truth(), done.result.trajectory);
  ASSERT_TRUE(ate);
  EXPECT_LT(ate->translation_m.rmse, 0.008);
}

TEST(System, BeginsWithTheFirstFrameThatShowsSomething) {
  const FinishedRun done = run(1, 0, 5);
  EXPECT_EQ(done.frames[4].status, TrackingStatus::kLost);
  EXPECT_EQ(done.frames[5].status, TrackingStatus::kInitialized);
  EXPECT_EQ(done.result.trajectory.size(), kRoomFrames - 5);
}

TEST(System, SaysThatItWasLostAtTheEnd) {
  const FinishedRun done = run(2, kRoomFrames - 3, kRoomFrames);
  EXPECT_TRUE(done.result.lost_at_end);
  EXPECT_EQ(done.result.trajectory.size(), kRoomFrames - 3);
}

TEST(System, OfNothingButDarknessGivesNothing) {
  const FinishedRun done = run(1, 0, kRoomFrames);
  EXPECT_TRUE(done.result.lost_at_end);
  EXPECT_TRUE(done.result.trajectory.empty());
  EXPECT_TRUE(done.result.keyframes.empty());
  EXPECT_TRUE(done.result.map.empty());
}

TEST(System, CanBeGivenUpWithJobsPending) {
  for (std::uint32_t frames_done = 1; frames_done < 8; ++frames_done) {
    System system({}, synthetic_camera(320, 240), {.threads = 2});
    for (std::uint32_t k = 0; k < frames_done; ++k) (void)system.process(empty_room().frame(k));
  }
}

// Two and a half seconds in which people with a chair and a carton pass close to the camera.
struct CrowdedFrames {
  std::vector<FramePtr> frames;
  std::vector<FrameDetections> detections;
  std::vector<FrameObjects> objects;
  Trajectory ground_truth;
};

const CrowdedFrames& crowded_frames() {
  static const CrowdedFrames kFramesOnce = [] {
    SyntheticOptions options;
    options.camera = synthetic_camera(320, 240);
    options.activity = Activity::kWalking;
    const SyntheticSequence office(options);
    CrowdedFrames crowded;
    ObjectTracker tracker({}, FillRule::kCausal);
    for (std::uint32_t k = 50; k < 125; ++k) {
      const FrameId id(k);
      const SyntheticFrame rendered = office.render(id);
      FrameTruth truth{id, office.stamp(id), ObjectMask(rendered.truth.ids), {}};
      for (const TruthFrameObject& seen : frame_objects(truth.mask, office.speeds(id))) {
        const char* name = seen.id < 10 ? "person" : seen.id < 13 ? "chair" : "box";
        truth.objects.push_back({seen.id, name, seen.box, seen.pixels, 1.0});
      }
      crowded.detections.push_back(perfect_detections(truth));
      crowded.objects.push_back(
          *tracker.push({id, crowded.detections.back(), rendered.frame->depth}));
      crowded.frames.push_back(rendered.frame);
      crowded.ground_truth.push_back({office.stamp(id), office.pose(id)});
    }
    return crowded;
  }();
  return kFramesOnce;
}

double error_among_people(const std::string& mode) {
  const CrowdedFrames& crowded = crowded_frames();
  SystemConfig config;
  config.dynamics.mode = mode;
  System system(config, synthetic_camera(320, 240), {.threads = 1});
  for (std::size_t i = 0; i < crowded.frames.size(); ++i) {
    (void)system.process(crowded.frames[i], crowded.objects[i]);
  }
  return absolute_trajectory_error(crowded.ground_truth, system.finish().trajectory)
      ->translation_m.rmse;
}

// The crowd with a network that works on every fourth frame and is done four frames later.
struct LiveCrowd {
  RunResult result;
  double ate_m = 0;
  std::set<std::string> looked_at;  // stamps
};

LiveCrowd live_crowd(bool keyframes_have_own_masks) {
  constexpr std::size_t kGap = 4;
  const CrowdedFrames& crowded = crowded_frames();
  SystemConfig config;
  config.dynamics.mode = "mask";  // only the masks keep people out
  System system(config, synthetic_camera(320, 240), {.threads = 2});
  ObjectTracker tracker({}, FillRule::kCausal);
  LiveCrowd live;
  for (std::size_t i = 0; i < crowded.frames.size(); ++i) {
    const FramePtr& frame = crowded.frames[i];
    std::optional<FrameObjects> earlier;
    if (i == 0) {
      EXPECT_TRUE(system.needs_own_objects());
      earlier = tracker.push({frame->id, crowded.detections[0], frame->depth});
      (void)system.process(frame, *earlier);
      live.looked_at.insert(frame->stamp.text);
      continue;
    }
    EXPECT_FALSE(system.needs_own_objects());
    if (i % kGap == 0 && i > kGap) {
      const FramePtr& then = crowded.frames[i - kGap];
      earlier = tracker.push({then->id, crowded.detections[i - kGap], then->depth});
      live.looked_at.insert(then->stamp.text);
    }
    MaskOrigin origin = i % kGap == 0 ? MaskOrigin::kAwaited : MaskOrigin::kCarried;
    if (!keyframes_have_own_masks) origin = MaskOrigin::kOwn;
    (void)system.process(frame, tracker.carry_to(frame->id, frame->stamp, frame->depth), origin);
    if (earlier) system.take_objects(*earlier);
  }
  live.result = system.finish();
  live.ate_m =
      absolute_trajectory_error(crowded.ground_truth, live.result.trajectory)->translation_m.rmse;
  return live;
}

// The number of points of the map that at least three frames, every third at its true pose, see
// through by more than 0.3 m.
std::size_t seen_through(const PointCloud& map, const Trajectory& ground_truth) {
  const CrowdedFrames& crowded = crowded_frames();
  const CameraModel camera = synthetic_camera(320, 240);
  const Eigen::Isometry3d T_truth_map = ground_truth.front().T_world_camera;
  std::size_t count = 0;
  for (const Eigen::Vector3f& p_map : map.positions) {
    int through = 0;
    for (std::size_t k = 0; k < crowded.frames.size(); k += 3) {
      const Eigen::Vector3d p =
          ground_truth[k].T_world_camera.inverse() * T_truth_map * p_map.cast<double>();
      if (p.z() < 0.3) continue;
      const Eigen::Vector2i px = camera.project(p).array().round().cast<int>();
      if (px.x() < 0 || px.y() < 0 || px.x() >= 320 || px.y() >= 240) continue;
      through += crowded.frames[k]->depth.mat(px.y(), px.x()) > p.z() + 0.3 ? 1 : 0;
    }
    count += through >= 3 ? 1 : 0;
  }
  return count;
}

TEST(System, KeyframesOfALiveRunWaitForMasksOfTheirOwn) {
  const LiveCrowd own = live_crowd(true);
  EXPECT_LT(own.ate_m, 0.025);
  EXPECT_EQ(own.result.trajectory.size(), crowded_frames().frames.size());
  EXPECT_GT(own.result.keyframes.size(), 2U);
  for (const StampedPose& keyframe : own.result.keyframes) {
    EXPECT_TRUE(own.looked_at.contains(keyframe.stamp.text));
  }
  const LiveCrowd carried = live_crowd(false);
  const Trajectory& truth = crowded_frames().ground_truth;
  EXPECT_GT(seen_through(carried.result.map, truth), 2 * seen_through(own.result.map, truth));
}

TEST(System, PeopleDisturbThePoseOnlyWithoutDynamics) {
  const double full = error_among_people("full");
  EXPECT_LT(full, 0.02);
  EXPECT_GT(error_among_people("off"), 3 * full);
}

TEST(System, GivesTheSameBitsForFramesPreparedAheadOnAnotherThread) {
  const CrowdedFrames& crowded = crowded_frames();
  System plain({}, synthetic_camera(320, 240), {.threads = 1});
  System hurried({}, synthetic_camera(320, 240), {.threads = 2});
  std::size_t next = 0;
  Prefetcher<PreparedFrame> ahead(
      [&]() -> std::optional<PreparedFrame> {
        if (next == crowded.frames.size()) return std::nullopt;
        const std::size_t i = next++;
        return hurried.prepare(crowded.frames[i], crowded.objects[i]);
      },
      4);
  for (std::size_t i = 0; i < crowded.frames.size(); ++i) {
    const FrameResult a = plain.process(crowded.frames[i], crowded.objects[i]);
    const FrameResult b = hurried.process(ahead.next().value());
    EXPECT_EQ(a.T_world_camera.matrix(), b.T_world_camera.matrix()) << i;
    ASSERT_EQ(a.features.size(), b.features.size()) << i;
    for (std::size_t k = 0; k < a.features.size(); ++k) {
      EXPECT_EQ(a.features[k].raw_px, b.features[k].raw_px) << i;
      EXPECT_EQ(a.features[k].tracked, b.features[k].tracked) << i;
    }
    EXPECT_EQ(cv::norm(a.excluded.mat, b.excluded.mat, cv::NORM_INF), 0.0) << i;
    EXPECT_GE(b.pose_ms, 0.0);
  }
  EXPECT_EQ(plain.finish().map.positions, hurried.finish().map.positions);
}

}  // namespace
}  // namespace stillmap
