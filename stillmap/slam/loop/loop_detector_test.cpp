// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_detector.hpp"

#include <gtest/gtest.h>

#include "tests/support/loops.hpp"

namespace stillmap {
namespace {

const SimulatedMap& one_submap() {
  static const SimulatedMap kRound = drifted_round(simulated_world(), {});
  return kRound;
}

// A place counts when so many key frames in a row have found it.
LoopConfig after(int key_frames) {
  LoopConfig config;
  config.gate.consecutive = key_frames;
  return config;
}

// The features of both that are said to see one point do.
void expect_true_loop(const SimulatedMap& simulated, const LoopMatch& loop) {
  const Eigen::Vector2d error = difference(loop.edge.T_a_b, true_T_a_b(simulated, loop));
  EXPECT_LT(error.x(), 0.02) << loop.edge.a.value << " - " << loop.edge.b.value;
  EXPECT_LT(error.y(), 0.01) << loop.edge.a.value << " - " << loop.edge.b.value;
  std::size_t wrong = 0;
  for (const auto& [in_earlier, in_later] : loop.matches) {
    wrong += simulated.points[loop.edge.a.index()][in_earlier] !=
                     simulated.points[loop.edge.b.index()][in_later]
                 ? 1
                 : 0;
  }
  EXPECT_GE(loop.matches.size(), 40U);
  EXPECT_EQ(wrong, 0U);
}

TEST(LoopDetector, FindsTheBeginningAtTheEndOfARoundAndNothingBefore) {
  const std::vector<LoopMatch> loops = find_loops(one_submap(), simulated_world());
  ASSERT_FALSE(loops.empty());
  for (const LoopMatch& loop : loops) {
    // Key frames that are more than five apart see nothing in common.
    EXPECT_GE(loop.edge.b.value, loop.edge.a.value + kRoundKeyframes - 5);
    expect_true_loop(one_submap(), loop);
  }
  EXPECT_EQ(loops.back().edge.b, KeyframeId(43));
}

TEST(LoopDetector, FindsKeyFramesOfAnotherSubmap) {
  const SimulatedMap two = drifted_round(
      simulated_world(),
      {.drift = Vector6d::Zero(),  // else what a key frame sees is as far off as what made it
       .second_submap_from = 36,
       .T_second_first = make_pose(so3_exp(Eigen::Vector3d(0.5, 1, 2)), {20, 30, 40})});
  const std::vector<LoopMatch> loops = find_loops(two, simulated_world());
  ASSERT_FALSE(loops.empty());
  bool of_beginning = false;
  for (const LoopMatch& loop : loops) {
    EXPECT_EQ(two.map.keyframe(loop.edge.a).submap, SubmapId(0));
    EXPECT_EQ(two.map.keyframe(loop.edge.b).submap, SubmapId(1));
    expect_true_loop(two, loop);
    of_beginning = of_beginning || loop.edge.a < KeyframeId(5);
  }
  EXPECT_TRUE(of_beginning);
  // What the first world had just seen is no neighbour, but a place of another world: it is found
  // as soon as the gate lets it pass.
  EXPECT_EQ(loops.front().edge.b, KeyframeId(38));
}

TEST(LoopDetector, OneImageIsNotEnough) {
  const std::vector<LoopMatch> at_once = find_loops(one_submap(), simulated_world(), after(1));
  const std::vector<LoopMatch> after_three = find_loops(one_submap(), simulated_world(), after(3));
  ASSERT_FALSE(at_once.empty());
  ASSERT_FALSE(after_three.empty());
  EXPECT_GT(after_three.front().edge.b, at_once.front().edge.b);
  const auto never = static_cast<int>(one_submap().map.keyframes().size()) + 1;
  EXPECT_TRUE(find_loops(one_submap(), simulated_world(), after(never)).empty());
}

TEST(LoopDetector, NothingBeforeTheRoundIsClosed) {
  EXPECT_TRUE(find_loops(one_submap(), simulated_world(), after(1), 34).empty());
}

TEST(LoopDetector, ClearedItBeginsAnew) {
  const KeyframeId first = find_loops(one_submap(), simulated_world()).front().edge.b;
  ASSERT_LT(first, KeyframeId(42));
  LoopDetector detector({}, simulated_world().camera(), loop_measure(simulated_world()), 0);
  PlaceIndex places;
  std::vector<std::uint32_t> found;
  for (const auto& [id, keyframe] : one_submap().map.keyframes()) {
    places.add(id, keyframe.features->descriptors);
    if (id == first) detector.clear();
    if (detector.advance(one_submap().map, places, id)) found.push_back(id.value);
  }
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front(), first.value + 2);
}

TEST(LoopDetector, PlacesThatAreNotInTheIndexAreNotFound) {
  // The index knows only what the end of the round has seen itself.
  LoopDetector detector(after(1), simulated_world().camera(), loop_measure(simulated_world()), 0);
  PlaceIndex places;
  for (std::uint32_t k = 36; k < 44; ++k) {
    const Keyframe& keyframe = one_submap().map.keyframe(KeyframeId(k));
    places.add(keyframe.id, keyframe.features->descriptors);
    EXPECT_FALSE(detector.advance(one_submap().map, places, keyframe.id)) << k;
  }
}

}  // namespace
}  // namespace stillmap
