// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/tracker.hpp"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/simulated_walk.hpp"

namespace stillmap {
namespace {

TEST(Tracker, FollowsASmoothPathAsWellAsTheNoiseAllows) {
  SimulatedWalk walk(path, {});
  EXPECT_EQ(walk.first().status, TrackingStatus::kInitialized);
  double normalized = 0;
  constexpr int kFrames = 150;
  for (int k = 1; k <= kFrames; ++k) {
    const Observed seen = walk.observe(k, kWalkNoise);
    const TrackedFrame frame = walk.track(k, seen.features);
    ASSERT_EQ(frame.status, TrackingStatus::kTracked) << k;
    EXPECT_LT(walk.error_m(frame), 0.015) << k;
    EXPECT_GT(frame.inliers, 100) << k;
    normalized += walk.normalized_error(frame) / kFrames;
    int wrong = 0;
    for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
      if (!frame.landmarks[i].valid()) continue;
      const Landmark& landmark = walk.map().landmark(frame.landmarks[i]);
      wrong += true_point(walk.simulated(), landmark) != seen.points[i] ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << k;
  }
  // The mean of 150 has a standard deviation of 0.28.
  EXPECT_NEAR(normalized, 6.0, 1.2);
}

TEST(Tracker, ExpectsTheLandmarksThatItFindsAndReadsTheMapOnly) {
  SimulatedWalk walk(path, {});
  const TrackedFrame frame = walk.track(1, walk.observe(1, kWalkNoise).features);
  const std::set<LandmarkId> expected(frame.expected.begin(), frame.expected.end());
  EXPECT_EQ(expected.size(), frame.expected.size());
  int found = 0;
  for (const LandmarkId id : frame.landmarks) {
    if (!id.valid()) continue;
    ++found;
    EXPECT_TRUE(expected.contains(id));
  }
  EXPECT_EQ(found, frame.inliers);
  EXPECT_TRUE(walk.map().has(frame.reference));
}

TEST(Tracker, StandsFortyPercentOfWrongDescriptors) {
  SimulatedWalk walk(path, {});
  ObservationNoise noise = kWalkNoise;
  noise.wrong_descriptor_share = 0.4;
  double normalized = 0;
  for (int k = 1; k <= 60; ++k) {
    const TrackedFrame frame = walk.track(k, walk.observe(k, noise).features);
    ASSERT_EQ(frame.status, TrackingStatus::kTracked) << k;
    EXPECT_LT(walk.error_m(frame), 0.015) << k;
    normalized += walk.normalized_error(frame) / 60;
  }
  EXPECT_NEAR(normalized, 6.0, 2.0);
}

TEST(Tracker, FollowsAPatternWhoseCornersLookAlike) {
  // About 15 corners in view look like each one: appearance alone finds nothing, only the last
  // frame tells where each is.
  const SimulatedWorld world({.kinds = 20}, simulated_camera());
  std::mt19937 rng(2);
  const Observed first = world.observe(path(0), kWalkNoise, rng);
  SimulatedMap simulated(world);
  add_true_keyframe(simulated, world, path(0), first);
  Tracker tracker = make_tracker();
  RgbdFrame frame;
  (void)tracker.start(frame, std::make_shared<const Features>(first.features));
  tracker.set_reference(KeyframeId(0), simulated.map);
  for (std::uint32_t k = 1; k <= 10; ++k) {
    frame.id = FrameId(k);
    frame.stamp.seconds = k * kFrameInterval_s;
    const Eigen::Isometry3d truth = path(frame.stamp.seconds);
    const TrackedFrame tracked = tracker.track(
        frame, world.observe(truth, kWalkNoise, rng).features, simulated.map, PlaceIndex());
    ASSERT_EQ(tracked.status, TrackingStatus::kTracked) << k;
    EXPECT_LT((tracked.T_world_camera.translation() - truth.translation()).norm(), 0.02);
  }
}

TEST(Tracker, StandsThirtyPercentOfMatchesThatMoved) {
  SimulatedWalk walk(path, {});
  for (int k = 1; k <= 60; ++k) {
    Features features = walk.observe(k, kWalkNoise).features;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (i % 10 >= 3) continue;
      features.raw_px[i].x() += 9.0F;  // by the same shift, as on a passing person
      features.ideal_px[i].x() += 9.0F;
    }
    const TrackedFrame frame = walk.track(k, std::move(features));
    ASSERT_EQ(frame.status, TrackingStatus::kTracked) << k;
    EXPECT_LT(walk.error_m(frame), 0.015) << k;
  }
}

TEST(Tracker, IsMarkedLostWithoutFeaturesAndFindsBack) {
  SimulatedWalk walk(path, {});
  for (int k = 1; k <= 40; ++k) {
    const bool dark = k > 20 && k <= 30;
    const Observed seen = dark ? Observed{} : walk.observe(k, kWalkNoise);
    const TrackedFrame frame = walk.track(k, seen.features);
    const TrackingStatus expected = dark      ? TrackingStatus::kLost
                                    : k == 31 ? TrackingStatus::kRelocalized
                                              : TrackingStatus::kTracked;
    ASSERT_EQ(frame.status, expected) << k;
    EXPECT_EQ(frame.landmarks.size(), seen.features.size());
    if (!dark) {
      EXPECT_LT(walk.error_m(frame), 0.015) << k;
    }
  }
}

TEST(Tracker, FindsBackAtAnotherPlaceThanWhereItWasLost) {
  SimulatedWalk walk(path, {});
  for (int k = 1; k <= 5; ++k) (void)walk.track(k, walk.observe(k, kWalkNoise).features);
  ASSERT_EQ(walk.track(6, {}).status, TrackingStatus::kLost);
  // Two seconds later, although the stamps do not say so: constant velocity does not lead there.
  const TrackedFrame frame = walk.track(66, walk.observe(66, kWalkNoise).features);
  EXPECT_EQ(frame.status, TrackingStatus::kRelocalized);
  EXPECT_LT(walk.error_m(frame), 0.015);
}

TEST(Tracker, MergedLandmarksAndDroppedKeyframesReachIt) {
  // The map changes between two frames: the reference is dropped, landmarks are merged, and the
  // whole world moves. Tracking goes on in the moved world.
  SimulatedMap simulated(SimulatedWalk::world());
  std::mt19937 rng(2);
  const Observed first = SimulatedWalk::world().observe(path(0), {}, rng);
  for (int copy = 0; copy < 2;
       ++copy) {  // two key frames at one place, with landmarks of their own
    const KeyframeId id = add_bare_keyframe(simulated, path(0), first);
    for (std::uint32_t i = 0; i < first.points.size(); ++i) {
      simulated.map.add_landmark(SimulatedWalk::world().points()[first.points[i]].position,
                                 {id, i});
    }
  }
  Tracker tracker = make_tracker();
  RgbdFrame frame;
  (void)tracker.start(frame, std::make_shared<const Features>(first.features));
  tracker.set_reference(KeyframeId(1), simulated.map);
  const auto count = static_cast<std::uint32_t>(first.points.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    simulated.map.merge_landmarks(LandmarkId(count + i), LandmarkId(i));
  }
  simulated.map.remove_keyframe(KeyframeId(1), KeyframeId(0));
  const Eigen::Isometry3d moved =
      make_pose(so3_exp(Eigen::Vector3d(0.5, -1, 2)), Eigen::Vector3d(10, -7, 3));
  simulated.map.set_pose(KeyframeId(0), moved);
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    simulated.map.set_position(id, moved * simulated.map.landmark(id).p_world);
    simulated.map.refresh(id);
  }
  frame.id = FrameId(1);
  frame.stamp.seconds = kFrameInterval_s;
  const Observed second = SimulatedWalk::world().observe(path(kFrameInterval_s), {}, rng);
  const TrackedFrame tracked = tracker.track(frame, second.features, simulated.map, PlaceIndex());
  ASSERT_EQ(tracked.status, TrackingStatus::kTracked);
  EXPECT_EQ(tracked.reference, KeyframeId(0));
  EXPECT_LT((tracked.T_world_camera.translation() - (moved * path(kFrameInterval_s)).translation())
                .norm(),
            1e-3);
  for (const LandmarkId id : tracked.landmarks) {
    if (id.valid()) {
      EXPECT_LT(id.value, count);
    }
  }
}

// Each feature of `seen`, and a copy slightly beside it and a level up, as corners often have.
Observed with_twins(const Observed& seen) {
  Observed doubled = seen;
  Features& f = doubled.features;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    f.raw_px.push_back(f.raw_px[i] + Eigen::Vector2f(0.5F, 0));
    f.ideal_px.push_back(f.raw_px.back());
    f.px.push_back(f.raw_px.back());
    f.sensor_depth_m.push_back(f.sensor_depth_m[i]);
    f.depth_m.push_back(f.depth_m[i]);
    f.level.push_back(static_cast<std::uint8_t>(std::min(f.level[i] + 1, 7)));
    f.angle_deg.push_back(f.angle_deg[i]);
    f.descriptors.push_back(f.descriptors[i]);
    f.descriptors.back()[0] ^= 0xff;
    doubled.points.push_back(doubled.points[i]);
  }
  f.grid = FeatureGrid(f.px, 640, 480);
  return doubled;
}

TEST(Tracker, UsesALandmarkOnceInAFrame) {
  // Two features of the last frame saw two landmarks, which have become one since.
  std::mt19937 rng(2);
  const Observed seen = with_twins(SimulatedWalk::world().observe(path(0), {}, rng));
  SimulatedMap simulated(SimulatedWalk::world());
  const KeyframeId id = add_bare_keyframe(simulated, path(0), seen);
  const auto count = static_cast<std::uint32_t>(seen.points.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    simulated.map.add_landmark(SimulatedWalk::world().points()[seen.points[i]].position, {id, i});
  }
  Tracker tracker = make_tracker();
  RgbdFrame frame;
  (void)tracker.start(frame, std::make_shared<const Features>(seen.features));
  tracker.set_reference(id, simulated.map);
  for (std::uint32_t i = 0; i < count / 2; ++i) {
    simulated.map.merge_landmarks(LandmarkId(count / 2 + i), LandmarkId(i));
  }
  frame.id = FrameId(1);
  frame.stamp.seconds = kFrameInterval_s;
  const TrackedFrame tracked = tracker.track(frame, seen.features, simulated.map, PlaceIndex());
  ASSERT_EQ(tracked.status, TrackingStatus::kTracked);
  std::set<LandmarkId> used;
  for (const LandmarkId landmark : tracked.landmarks) {
    if (landmark.valid()) {
      EXPECT_TRUE(used.insert(landmark).second) << landmark.value;
    }
  }
}

// The error of the later half of 240 poses with a rolling shutter of 30 ms, for which the tracker
// corrects features as for `assumed_s`.
double rolling_rmse_m(double assumed_s) {
  SimulatedWalk walk(path, {}, 0.03);
  walk.assume({assumed_s, 0});
  double sum = 0;
  for (int k = 1; k <= 240; ++k) {
    const TrackedFrame frame = walk.track(k, walk.observe(k, kWalkNoise).features);
    EXPECT_EQ(frame.status, TrackingStatus::kTracked) << k;
    EXPECT_EQ(frame.timing.assumed.readout_s, assumed_s);
    if (k > 120) sum += walk.error_m(frame) * walk.error_m(frame) / 120;
  }
  return std::sqrt(sum);
}

TEST(Tracker, IsMuchBetterForKnowingTheRollingShutter) {
  EXPECT_LT(rolling_rmse_m(0.03), 0.3 * rolling_rmse_m(0));
}

}  // namespace
}  // namespace stillmap
