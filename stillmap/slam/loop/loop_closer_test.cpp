// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_closer.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/loops.hpp"
#include "tests/support/same_map.hpp"

namespace stillmap {
namespace {

constexpr ObservationNoise kNoWrongDescriptors{
    .pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.004, .flipped_bits = 10};

bool close(SimulatedMap& simulated, std::vector<LoopEdge>& loops, const LoopMatch& found) {
  return close_loop(
      simulated.map, loops, found, simulated_world().camera(), loop_measure(simulated_world()), {});
}

// Points of the world that both see, each with a landmark of its own.
std::size_t doubled(const SimulatedMap& simulated, KeyframeId a, KeyframeId b) {
  std::map<std::uint32_t, LandmarkId> in_a;
  const std::vector<LandmarkId>& landmarks_a = simulated.map.keyframe(a).landmarks;
  const std::vector<LandmarkId>& landmarks_b = simulated.map.keyframe(b).landmarks;
  for (std::size_t i = 0; i < landmarks_a.size(); ++i) {
    if (landmarks_a[i].valid()) in_a[simulated.points[a.index()][i]] = landmarks_a[i];
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < landmarks_b.size(); ++i) {
    const auto same_point = in_a.find(simulated.points[b.index()][i]);
    const bool doubled =
        landmarks_b[i].valid() && same_point != in_a.end() && same_point->second != landmarks_b[i];
    count += doubled ? 1 : 0;
  }
  return count;
}

// Observations that are not of the point that their landmark is of.
std::size_t wrong_observations(const SimulatedMap& simulated) {
  std::size_t wrong = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    const std::uint32_t point = true_point(simulated, landmark);
    for (const Observation& o : landmark.observations) {
      wrong += simulated.points[o.keyframe.index()][o.feature] == point ? 0 : 1;
    }
  }
  return wrong;
}

TEST(LoopCloser, TheDriftOfARoundGoes) {
  SimulatedMap round = drifted_round(simulated_world(), {});
  const double before_m = mean_error_m(round);
  const LoopMatch found = find_loops(round, simulated_world()).back();
  std::vector<LoopEdge> loops;
  ASSERT_TRUE(close(round, loops, found));
  round.map.check_consistency();
  EXPECT_GT(before_m, 0.08);
  EXPECT_LT(mean_error_m(round), before_m / 3);
  // The landmarks went with their key frames: they stand where the world has their points.
  double landmarks_m = 0;
  for (const LandmarkId id : round.map.landmark_ids()) {
    const Landmark& landmark = round.map.landmark(id);
    landmarks_m +=
        (landmark.p_world - simulated_world().points()[true_point(round, landmark)].position)
            .norm();
  }
  EXPECT_LT(landmarks_m / static_cast<double>(round.map.landmark_count()), 0.08);
  EXPECT_EQ(round.map.keyframe(KeyframeId(0)).T_world_camera.matrix(), round_pose(0).matrix());
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].a, found.edge.a);
  EXPECT_EQ(loops[0].b, found.edge.b);
  EXPECT_EQ(loops[0].T_a_b.matrix(), found.edge.T_a_b.matrix());
  EXPECT_EQ(loops[0].sigma_m, found.edge.sigma_m);
  EXPECT_EQ(loops[0].sigma_rad, found.edge.sigma_rad);
}

TEST(LoopCloser, LandmarksOfBothEndsBecomeOne) {
  SimulatedMap round = drifted_round(
      simulated_world(),
      {.noise = {.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.004, .flipped_bits = 10}});
  ASSERT_EQ(wrong_observations(round), 0U);
  const LoopMatch found = find_loops(round, simulated_world()).back();
  const std::size_t landmarks = round.map.landmark_count();
  const std::size_t doubled_before = doubled(round, found.edge.a, found.edge.b);
  ASSERT_GT(doubled_before, 100U);
  std::vector<LoopEdge> loops;
  ASSERT_TRUE(close(round, loops, found));
  EXPECT_LT(doubled(round, found.edge.a, found.edge.b), doubled_before / 10);
  EXPECT_EQ(wrong_observations(round), 0U);
  EXPECT_LT(round.map.landmark_count(), landmarks - doubled_before / 2);
  // Also those of the neighbours, which the loop itself does not name.
  const KeyframeId before_later(found.edge.b.value - 2);
  EXPECT_LT(doubled(round, found.edge.a, before_later), 30U);
}

// Takes every third landmark from a key frame.
void rob(SimulatedMap& simulated, KeyframeId id) {
  const std::vector<LandmarkId> landmarks = simulated.map.keyframe(id).landmarks;
  for (std::size_t i = 0; i < landmarks.size(); i += 3) {
    if (landmarks[i].valid()) simulated.map.remove_observation(landmarks[i], id);
  }
}

// Features of `a` without a landmark where `b` knows one of their point.
std::size_t missing(const SimulatedMap& simulated, KeyframeId a, KeyframeId b) {
  std::set<std::uint32_t> known;
  const std::vector<LandmarkId>& landmarks_a = simulated.map.keyframe(a).landmarks;
  const std::vector<LandmarkId>& landmarks_b = simulated.map.keyframe(b).landmarks;
  for (std::size_t i = 0; i < landmarks_b.size(); ++i) {
    if (landmarks_b[i].valid()) known.insert(simulated.points[b.index()][i]);
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < landmarks_a.size(); ++i) {
    const bool is_known = known.contains(simulated.points[a.index()][i]);
    count += !landmarks_a[i].valid() && is_known ? 1 : 0;
  }
  return count;
}

TEST(LoopCloser, FeaturesOfOneEndGetTheLandmarksOfTheOther) {
  SimulatedMap round =
      drifted_round(simulated_world(), {.drift = Vector6d::Zero(), .noise = kNoWrongDescriptors});
  const LoopMatch found = find_loops(round, simulated_world()).back();
  const KeyframeId beside_later(found.edge.b.value - 1), beside_earlier(found.edge.a.value + 1);
  for (const KeyframeId id : {beside_later, beside_earlier}) rob(round, id);
  const std::size_t in_later = missing(round, beside_later, found.edge.a);
  const std::size_t in_earlier = missing(round, beside_earlier, found.edge.b);
  ASSERT_GT(in_later, 50U);
  ASSERT_GT(in_earlier, 50U);
  std::vector<LoopEdge> loops;
  ASSERT_TRUE(close(round, loops, found));
  round.map.check_consistency();
  EXPECT_LT(missing(round, beside_later, found.edge.a), in_later / 3);
  EXPECT_LT(missing(round, beside_earlier, found.edge.b), in_earlier / 3);
  EXPECT_EQ(wrong_observations(round), 0U);
}

TEST(LoopCloser, WhatTheLoopMatchedBecomesOneAlsoWhereNothingElseIsLookedFor) {
  SimulatedMap round = drifted_round(simulated_world(), {});
  const LoopMatch found = find_loops(round, simulated_world()).back();
  for (const KeyframeId id : {found.edge.a, found.edge.b}) rob(round, id);
  const Keyframe earlier = round.map.keyframe(found.edge.a),
                 later = round.map.keyframe(found.edge.b);
  LoopConfig config;
  config.fusion.radius_px = 1e-9;
  std::vector<LoopEdge> loops;
  ASSERT_TRUE(close_loop(round.map,
                         loops,
                         found,
                         simulated_world().camera(),
                         loop_measure(simulated_world()),
                         config));
  round.map.check_consistency();
  int old_kept = 0, taken_over = 0;
  for (const auto& [in_earlier, in_later] : found.matches) {
    const LandmarkId old = earlier.landmarks[in_earlier], recent = later.landmarks[in_later];
    const LandmarkId now = round.map.keyframe(found.edge.a).landmarks[in_earlier];
    EXPECT_EQ(now, round.map.keyframe(found.edge.b).landmarks[in_later]);
    EXPECT_EQ(now, old.valid() ? old : recent);
    old_kept += old.valid() && !recent.valid() ? 1 : 0;
    taken_over += recent.valid() && !old.valid() ? 1 : 0;
  }
  EXPECT_GT(old_kept, 10);
  EXPECT_GT(taken_over, 10);
}

TEST(LoopCloser, WhatContradictsTheOthersIsRefusedAndChangesNothing) {
  SimulatedMap round = drifted_round(simulated_world(), {});
  const double before_m = mean_error_m(round);
  const std::vector<LoopMatch> found = find_loops(round, simulated_world());
  ASSERT_GE(found.size(), 3U);
  std::vector<LoopEdge> loops;
  for (const LoopMatch& right : found) ASSERT_TRUE(close(round, loops, right));
  EXPECT_EQ(loops.size(), found.size());
  EXPECT_LT(mean_error_m(round), before_m / 3);
  LoopMatch wrong = found.back();
  wrong.edge.T_a_b = Eigen::Translation3d(0.5, 0, 0) * wrong.edge.T_a_b;
  const MapParts before = round.map.parts();
  EXPECT_FALSE(close(round, loops, wrong));
  expect_same(round.map.parts(), before);
  EXPECT_EQ(loops.size(), found.size());
  const MapUpdate changes = round.map.take_changes();
  EXPECT_TRUE(changes.keyframes.empty() && changes.landmarks.empty());
  // The right one is still welcome.
  EXPECT_TRUE(close(round, loops, found.back()));
}

class LoopCloserOfTwoSubmaps : public testing::Test {
 protected:
  // Without drift within either: what is left is the error of the loop.
  LoopCloserOfTwoSubmaps()
      : two_(drifted_round(
            simulated_world(),
            {.drift = Vector6d::Zero(),
             .second_submap_from = 36,
             .T_second_first = make_pose(so3_exp(Eigen::Vector3d(0.5, 1, 2)), {20, 30, 40})})),
        found_(find_loops(two_, simulated_world()).back()) {}

  void expect_joined() {
    two_.map.check_consistency();
    EXPECT_EQ(two_.map.submaps(), std::vector<SubmapId>{SubmapId(0)});
    for (const auto& [id, keyframe] : two_.map.keyframes()) {
      const Eigen::Vector2d error = difference(keyframe.T_world_camera, round_pose(id.value));
      EXPECT_LT(error.x(), id.value < 36 ? 1e-12 : 0.02) << id.value;
      EXPECT_LT(error.y(), id.value < 36 ? 1e-12 : 0.01) << id.value;
      EXPECT_EQ(keyframe.is_origin, id.value == 0);
    }
    double farthest_m = 0;
    for (const LandmarkId id : two_.map.landmark_ids()) {
      const Landmark& landmark = two_.map.landmark(id);
      const Eigen::Vector3d& truth =
          simulated_world().points()[true_point(two_, landmark)].position;
      farthest_m = std::max(farthest_m, (landmark.p_world - truth).norm());
    }
    EXPECT_LT(farthest_m, 0.1);
    EXPECT_LT(doubled(two_, found_.edge.a, found_.edge.b), doubled_ / 10);
    EXPECT_EQ(wrong_observations(two_), 0U);
    EXPECT_EQ(loops_.size(), 1U);
  }

  SimulatedMap two_;
  LoopMatch found_;
  std::vector<LoopEdge> loops_;
  std::size_t doubled_ = doubled(two_, found_.edge.a, found_.edge.b);
};

TEST_F(LoopCloserOfTwoSubmaps, TheLaterMovesOntoTheEarlier) {
  ASSERT_GT(doubled_, 100U);
  ASSERT_TRUE(close(two_, loops_, found_));
  expect_joined();
}

TEST_F(LoopCloserOfTwoSubmaps, AlsoWhenTheEarlierSubmapIsTheOneThatFinds) {
  std::swap(found_.edge.a, found_.edge.b);
  found_.edge.T_a_b = found_.edge.T_a_b.inverse();
  for (auto& [in_earlier, in_later] : found_.matches) std::swap(in_earlier, in_later);
  ASSERT_TRUE(close(two_, loops_, found_));
  expect_joined();
}

}  // namespace
}  // namespace stillmap
