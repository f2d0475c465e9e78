// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/append.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/session/session_map.hpp"
#include "tests/support/sessions.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Each has key frames 0 to 5, of which 2 and 3 are dropped, in the submaps 0 and 2, and nine
// frames.
class Append : public testing::Test {
 protected:
  static Session second_session() {
    Session session = random_session(2);
    session.camera.name = "of the second";
    session.config_yaml = "seed: 99\n";
    return session;
  }

  const Session first_ = random_session(1), second_ = second_session();
  const Session both_ = appended(first_, second_);
  const std::uint32_t landmarks_ = first_.map.parts().next_landmark.value;
};

TEST_F(Append, KeepsTheFirstAsItIs) {
  expect_same(both_.camera, first_.camera);
  EXPECT_EQ(both_.config_yaml, first_.config_yaml);
  for (const auto& [id, keyframe] : first_.map.keyframes()) {
    expect_same(both_.map.keyframe(id), keyframe);
  }
  for (const LandmarkId id : first_.map.landmark_ids()) {
    expect_same(both_.map.landmark(id), first_.map.landmark(id));
  }
  Session start = both_;
  start.map = first_.map;
  start.loops.resize(first_.loops.size());
  start.frames = {};
  for (std::size_t i = 0; i < first_.frames.size(); ++i) start.frames.push_back(both_.frames[i]);
  start.views.resize(first_.views.size());
  start.objects.resize(first_.objects.size());
  expect_same(start, first_);
}

TEST_F(Append, ObjectsOfTheSecondFollow) {
  ASSERT_EQ(both_.objects.size(), 4U);
  EXPECT_EQ(both_.objects[2].track, TrackId(8));
  EXPECT_EQ(both_.objects[3].track, TrackId(11));
  EXPECT_EQ(both_.objects[2].surface, second_.objects[0].surface);
}

TEST_F(Append, KeyFramesOfTheSecondFollow) {
  both_.map.check_consistency();
  EXPECT_EQ(both_.map.keyframes().size(), 8U);
  EXPECT_THAT(both_.map.submaps(), ElementsAre(SubmapId(0), SubmapId(2), SubmapId(3), SubmapId(5)));
  for (const auto& [id, before] : second_.map.keyframes()) {
    Keyframe after = both_.map.keyframe(KeyframeId(id.value + 6));
    for (std::size_t i = 0; i < after.landmarks.size(); ++i) {
      if (!before.landmarks[i].valid()) {
        EXPECT_FALSE(after.landmarks[i].valid());
      } else {
        EXPECT_EQ(after.landmarks[i].value, before.landmarks[i].value + landmarks_);
      }
    }
    EXPECT_EQ(after.id.value, id.value + 6);
    EXPECT_EQ(after.submap.value, before.submap.value + 3);
    after.id = id;
    after.submap = before.submap;
    after.landmarks = before.landmarks;
    expect_same(after, before);
  }
  for (const std::uint32_t dropped : {2U, 3U}) {
    EXPECT_FALSE(both_.map.has(KeyframeId(dropped + 6)));
    EXPECT_EQ(both_.map.anchor(KeyframeId(dropped + 6)).keyframe, KeyframeId(7));
    EXPECT_EQ(both_.map.T_world_keyframe(KeyframeId(dropped + 6)).matrix(),
              second_.map.T_world_keyframe(KeyframeId(dropped)).matrix());
  }
}

TEST_F(Append, LandmarksOfTheSecondFollow) {
  ASSERT_GT(second_.map.landmark_count(), 10U);
  EXPECT_EQ(both_.map.landmark_count(), first_.map.landmark_count() + second_.map.landmark_count());
  for (const LandmarkId id : second_.map.landmark_ids()) {
    const Landmark& before = second_.map.landmark(id);
    Landmark after = both_.map.landmark(LandmarkId(id.value + landmarks_));
    EXPECT_EQ(after.created_by.value, before.created_by.value + 6);
    for (Observation& o : after.observations) o.keyframe = KeyframeId(o.keyframe.value - 6);
    after.id = id;
    after.created_by = before.created_by;
    expect_same(after, before);
  }
}

TEST_F(Append, NewOnesComeAfterAll) {
  const std::uint32_t landmarks = landmarks_ + second_.map.parts().next_landmark.value;
  Map map = both_.map;
  std::mt19937 rng(3);
  Keyframe keyframe = random_keyframe(rng);
  keyframe.submap = SubmapId(5);
  const KeyframeId id = map.add_keyframe(std::move(keyframe));
  EXPECT_EQ(id, KeyframeId(12));
  EXPECT_FALSE(map.keyframe(id).is_origin);
  EXPECT_EQ(map.add_landmark({1, 2, 3}, {id, 0}), LandmarkId(landmarks));
}

TEST_F(Append, FramesAndViewsOfTheSecondStandWhereTheyStood) {
  ASSERT_EQ(both_.frames.size(), 18U);
  for (std::size_t i = 0; i < 9; ++i) {
    const FrameRecord before = second_.frames[i], after = both_.frames[i + 9];
    EXPECT_EQ(after.reference.value, before.reference.value + 6);
    EXPECT_EQ(after.stamp.text, before.stamp.text);
    EXPECT_EQ(after.stamp.seconds, before.stamp.seconds);
    EXPECT_EQ(T_world_frame(both_, after).matrix(), T_world_frame(second_, before).matrix());
    EXPECT_EQ(submap_of(both_, after).value, submap_of(second_, before).value + 3);
  }
  ASSERT_EQ(both_.views.size(), first_.views.size() + second_.views.size());
  for (std::size_t i = 0; i < second_.views.size(); ++i) {
    const ViewRecord& after = both_.views[i + first_.views.size()];
    EXPECT_EQ(after.frame, second_.views[i].frame + 9);
    EXPECT_EQ(after.view, second_.views[i].view);
  }
}

TEST_F(Append, LoopsOfTheSecondFollow) {
  ASSERT_EQ(both_.loops.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    const LoopEdge &before = second_.loops[i], &after = both_.loops[i + 2];
    EXPECT_EQ(after.a.value, before.a.value + 6);
    EXPECT_EQ(after.b.value, before.b.value + 6);
    EXPECT_EQ(after.T_a_b.matrix(), before.T_a_b.matrix());
    EXPECT_EQ(after.sigma_m, before.sigma_m);
    EXPECT_EQ(after.sigma_rad, before.sigma_rad);
  }
}

TEST_F(Append, EmptySessionAddsNothing) {
  Session empty;
  empty.camera = first_.camera;
  empty.config_yaml = first_.config_yaml;
  empty.map = Map(test_scales());
  expect_same(appended(first_, empty), first_);
  expect_same(appended(empty, first_), first_);
}

// A session without landmarks whose next ones would have these ids.
Session counted_to(std::uint32_t next_keyframe, std::uint32_t next_landmark) {
  MapParts parts;
  parts.level_scales = test_scales();
  parts.next_keyframe = KeyframeId(next_keyframe);
  parts.next_landmark = LandmarkId(next_landmark);
  Session session;
  session.map = Map::from_parts(std::move(parts), "test");
  return session;
}

TEST(AppendLimits, MoreThanIdsCanCountAreRefused) {
  constexpr std::uint32_t kHalf = std::uint32_t{1} << 30U, kAll = 2 * kHalf;
  const auto refused = ThrowsMessage<Error>(HasSubstr("together have more key frames"));
  const auto append = [](const Session& a, const Session& b) {
    return [=] { (void)appended(a, b); };
  };
  EXPECT_THAT(append(counted_to(kAll, 0), counted_to(kAll, 0)), refused);
  EXPECT_THAT(append(counted_to(kAll, 0), counted_to(1, 0)), refused);
  EXPECT_THAT(append(counted_to(0, 1), counted_to(0, kAll)), refused);
  const Session full = appended(counted_to(kHalf, kHalf), counted_to(kHalf, kHalf));
  EXPECT_EQ(full.map.parts().next_keyframe, KeyframeId(kAll));
  EXPECT_EQ(full.map.parts().next_landmark, LandmarkId(kAll));
}

TEST(AppendLimits, SubmapsCountToo) {
  const auto with_submap = [](std::uint32_t submap) {
    Keyframe keyframe;
    keyframe.features = std::make_shared<const Features>();
    keyframe.submap = SubmapId(submap);
    Session session = counted_to(0, 0);
    session.map.add_keyframe(std::move(keyframe));
    return session;
  };
  const Session last = with_submap((std::uint32_t{1} << 31U) - 1);
  EXPECT_THROW((void)appended(last, with_submap(0)), Error);
  EXPECT_EQ(appended(last, counted_to(0, 0)).map.submaps(), last.map.submaps());
}

}  // namespace
}  // namespace stillmap
