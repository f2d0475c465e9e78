// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/camera_times.hpp"

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

const SimulatedWorld& world() {
  static const SimulatedWorld kWorld({.points = 500}, simulated_camera());
  return kWorld;
}

CameraModel camera_stating(double readout_s) {
  CameraModel camera = world().camera();
  camera.readout_s = readout_s;
  return camera;
}

TimeEvidence evidence_of(const CameraTimes& times, double sigma_s) {
  TimeEvidence evidence;
  evidence.information = Eigen::Matrix2d::Identity() / (sigma_s * sigma_s);
  evidence.vector = evidence.information * Eigen::Vector2d(times.readout_s, times.depth_delay_s);
  return evidence;
}

TEST(CameraTimesEstimator, BelievesWhatDiffersFromTheFileByFourSigmas) {
  CameraTimesEstimator doubted({}, camera_stating(0)), believed({}, camera_stating(0));
  doubted.add(evidence_of({0.02, -0.02}, 0.0052));
  EXPECT_EQ(doubted.times().readout_s, 0);
  EXPECT_EQ(doubted.times().depth_delay_s, 0);
  believed.add(evidence_of({0.02, -0.02}, 0.0048));
  EXPECT_NEAR(believed.times().readout_s, 0.02, 1e-9);
  EXPECT_NEAR(believed.times().depth_delay_s, -0.02, 1e-9);
}

// Each window has most of the observations of the one before.
TEST(CameraTimesEstimator, ManyWindowsThatSayTheSameAreNoBetterThanOne) {
  CameraTimesEstimator estimator({}, camera_stating(0));
  for (int i = 0; i < 500; ++i) estimator.add(evidence_of({0.02, 0}, 0.0052));
  EXPECT_EQ(estimator.times().readout_s, 0);
}

TEST(CameraTimesEstimator, CorrectsAFileThatIsWrongAndKeepsOneThatIsRight) {
  CameraTimesEstimator wrong({}, camera_stating(0.03)), right({}, camera_stating(0.02));
  for (CameraTimesEstimator* estimator : {&wrong, &right}) {
    EXPECT_GT(estimator->times().readout_s, 0.01);
    estimator->add(evidence_of({0.0205, 0}, 0.0005));
  }
  EXPECT_NEAR(wrong.times().readout_s, 0.0205, 1e-9);
  EXPECT_EQ(right.times().readout_s, 0.02);
}

TEST(CameraTimesEstimator, LearnsAnewWhenTheCameraChanges) {
  CameraTimesEstimator estimator({}, camera_stating(0));
  for (int i = 0; i < 50; ++i) estimator.add(evidence_of({0.01, 0}, 0.0005));
  for (int i = 0; i < 100; ++i) estimator.add(evidence_of({0.03, 0}, 0.0005));
  EXPECT_NEAR(estimator.times().readout_s, 0.03, 2e-4);
}

TEST(CameraTimesEstimator, StaysWithinItsBounds) {
  CameraTimesEstimator estimator({.max_readout_s = 0.02, .max_depth_delay_s = 0.01},
                                 camera_stating(0));
  estimator.add(evidence_of({0.05, -0.05}, 0.001));
  EXPECT_EQ(estimator.times().readout_s, 0.02);
  EXPECT_EQ(estimator.times().depth_delay_s, -0.01);
  estimator.add(evidence_of({-5, 5}, 0.001));
  EXPECT_EQ(estimator.times().readout_s, 0);
  EXPECT_EQ(estimator.times().depth_delay_s, 0.01);
}

TEST(CameraTimesEstimator, KeepsWhatIsStatedWithoutEvidenceOrCalibration) {
  CameraTimesEstimator off({.calibrate = false}, camera_stating(0.01));
  off.add(evidence_of({0.03, 0}, 0.0001));
  EXPECT_EQ(off.times().readout_s, 0.01);
  CameraTimesEstimator standing({}, camera_stating(0.01));
  standing.add({});
  EXPECT_EQ(standing.times().readout_s, 0.01);
}

TEST(CorrectTimes, BringsKeyframesToTheTimesAsKnownAndLeavesThoseOfLoadedMaps) {
  constexpr double kReadout_s = 0.03;
  const CameraPath path = [](double t) { return swinging(t); };
  SimulatedMap simulated(world());
  std::mt19937 rng(1);
  std::vector<KeyframeId> ids;
  std::vector<Observed> truth;
  for (const double t : {1.0, 2.0}) {
    const Observed seen = world().observe_rolling(path, t, kReadout_s, {}, rng);
    truth.push_back(seen);
    ids.push_back(add_bare_keyframe(simulated, path(t), seen));
  }
  const CameraVelocity velocity = mean_velocity(path(0.999).inverse() * path(1.001), 0.002);
  simulated.map.set_features(
      ids[0], simulated.map.keyframe(ids[0]).features, {velocity, velocity, 0, {}});
  (void)simulated.map.take_changes();
  correct_times(simulated.map, ids, world().camera(), {kReadout_s, 0});
  const MapUpdate changes = simulated.map.take_changes();
  ASSERT_EQ(changes.keyframes.size(), 1U);
  EXPECT_EQ(changes.keyframes[0].id, ids[0]);
  EXPECT_EQ(changes.keyframes[0].timing.assumed.readout_s, kReadout_s);
  double before = 0, after = 0;
  const Features& corrected = *changes.keyframes[0].features;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    const Eigen::Vector3d& p = world().points()[truth[0].points[i]].position;
    const Eigen::Vector2d px = world().camera().project(path(1.0).inverse() * p);
    before = std::max(before, (truth[0].features.px[i].cast<double>() - px).norm());
    after = std::max(after, (corrected.px[i].cast<double>() - px).norm());
  }
  EXPECT_GT(before, 1);
  EXPECT_LT(after, 0.1 * before);
}

}  // namespace
}  // namespace stillmap
