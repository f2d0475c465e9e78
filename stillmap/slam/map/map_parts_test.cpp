// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/map_parts.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/slam/map/map.hpp"
#include "tests/support/random_map.hpp"
#include "tests/support/same_map.hpp"

namespace stillmap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Key frames 0 to 5, of which 2 and 3 are dropped (3 is fixed to 2, which then was fixed to 1).
Map some_map(std::uint32_t seed) {
  std::mt19937 rng(seed);
  Map map(test_scales());
  for (int i = 0; i < 6; ++i) {
    Keyframe keyframe = random_keyframe(rng);
    Features features = *keyframe.features;
    const std::size_t size = features.size();
    features.raw_px = features.ideal_px = features.px;
    features.sensor_depth_m.assign(size, 1.5F);
    features.depth_m.assign(size, 1.25F);
    features.angle_deg.assign(size, 30.0F);
    keyframe.features = std::make_shared<const Features>(std::move(features));
    keyframe.submap = SubmapId(i < 4 ? 0 : 2);
    map.add_keyframe(std::move(keyframe));
  }
  for (int i = 0; i < 150; ++i) random_operation(map, {}, rng)(map);
  map.remove_keyframe(KeyframeId(3), KeyframeId(2));
  map.remove_keyframe(KeyframeId(2), KeyframeId(1));
  return map;
}

TEST(MapParts, MakeTheSameMap) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Map map = some_map(seed);
    MapParts parts = map.parts();
    for (Keyframe& keyframe : parts.keyframes) keyframe.landmarks.clear();  // made anew
    Map copy = Map::from_parts(std::move(parts), "x");
    copy.check_consistency();
    expect_same(copy.parts(), map.parts());
    EXPECT_EQ(copy.T_world_keyframe(KeyframeId(3)).matrix(),
              map.T_world_keyframe(KeyframeId(3)).matrix());
    EXPECT_TRUE(copy.take_changes().keyframes.empty());
    std::mt19937 rng(1);
    EXPECT_EQ(copy.add_keyframe(random_keyframe(rng)), KeyframeId(6));
  }
}

// Makes one thing of a key frame's features wrong.
void spoil(Keyframe& keyframe, const std::function<void(Features&)>& change) {
  Features features = *keyframe.features;
  change(features);
  keyframe.features = std::make_shared<const Features>(std::move(features));
}

struct Wrong {
  std::string part_of_message;
  std::function<void(MapParts&)> change;
};

void expect_refused(const std::vector<Wrong>& wrongs) {
  for (const Wrong& wrong : wrongs) {
    MapParts parts = some_map(1).parts();
    ASSERT_GE(parts.landmarks.size(), 3U);
    wrong.change(parts);
    try {
      (void)Map::from_parts(std::move(parts), "a.stillmap");
      ADD_FAILURE() << "accepted: " << wrong.part_of_message;
    } catch (const Error& error) {
      EXPECT_THAT(
          error.what(),
          testing::MatchesRegex("a.stillmap: invalid [^\n]*" + wrong.part_of_message + "[^\n]*"));
    }
  }
}

TEST(MapParts, WrongKeyframesAreRefused) {
  using P = MapParts&;
  expect_refused({
      {"key frame 0: its id", [](P p) { p.keyframes[1].id = KeyframeId(0); }},
      {"key frame 5: its id", [](P p) { p.next_keyframe = KeyframeId(5); }},
      {"key frame 1: its submap", [](P p) { p.keyframes[1].submap = SubmapId{}; }},
      {"key frame 1: a second origin", [](P p) { p.keyframes[1].is_origin = true; }},
      {"submaps: one has no origin", [](P p) { p.keyframes[2].is_origin = false; }},
      {"key frame 1: its pose", [](P p) { p.keyframes[1].T_world_camera(0, 3) = kNaN; }},
      {"key frame 1: its pose", [](P p) { p.keyframes[1].T_world_camera(0, 3) = 1e10; }},
      {"key frame 1: its pose", [](P p) { p.keyframes[1].T_world_camera(1, 1) += 1e-5; }},
      {"key frame 1: its pose", [](P p) { p.keyframes[1].T_world_camera.linear() *= -1; }},
      {"key frame 1: its stamp", [](P p) { p.keyframes[1].stamp.seconds = kNaN; }},
      {"key frame 1: its stamp", [](P p) { p.keyframes[1].stamp.text = "1\n2"; }},
      {"key frame 1: its features", [](P p) { p.keyframes[1].features = nullptr; }},
      {"key frame 1: arrays",
       [](P p) { spoil(p.keyframes[1], [](Features& f) { f.depth_m.pop_back(); }); }},
      {"key frame 1: a feature's pixel",
       [](P p) { spoil(p.keyframes[1], [](Features& f) { f.px[2].y() = NAN; }); }},
      {"key frame 1: a feature's level",
       [](P p) { spoil(p.keyframes[1], [](Features& f) { f.level[2] = 4; }); }},
      {"scales", [](P p) { p.level_scales.clear(); }},
      {"scales", [](P p) { p.level_scales[1] = 0.5F; }},
      {"next ids", [](P p) { p.next_landmark = LandmarkId{}; }},
  });
}

TEST(MapParts, WrongAnchorsAreRefused) {
  using P = MapParts&;
  const auto anchor = [](P p, std::size_t i) -> Anchor& { return p.dropped_keyframes[i].second; };
  expect_refused({
      {"dropped key frame 2: its id", [](P p) { p.dropped_keyframes[1].first = KeyframeId(2); }},
      {"dropped key frame 1: its id", [](P p) { p.dropped_keyframes[0].first = KeyframeId(1); }},
      {"dropped key frame 6: its id", [](P p) { p.dropped_keyframes[1].first = KeyframeId(6); }},
      {"dropped key frame 2: its pose", [=](P p) { anchor(p, 0).T_anchor_dropped(2, 3) = kNaN; }},
      {"a circle", [=](P p) { anchor(p, 0).keyframe = KeyframeId(3); }},
      {"a circle", [=](P p) { anchor(p, 0).keyframe = KeyframeId(2); }},
      {"an unknown key frame", [=](P p) { anchor(p, 0).keyframe = KeyframeId{}; }},
  });
}

TEST(MapParts, WrongLandmarksAreRefused) {
  using P = MapParts&;
  expect_refused({
      {"its id", [](P p) { p.landmarks[1].id = p.landmarks[0].id; }},
      {"its id", [](P p) { p.next_landmark = p.landmarks.back().id; }},
      {"the key frame that made it", [](P p) { p.landmarks[0].created_by = KeyframeId(6); }},
      {"its position", [](P p) { p.landmarks[0].p_world.y() = kNaN; }},
      {"its viewing direction", [](P p) { p.landmarks[0].viewing_direction.z() = kNaN; }},
      {"its viewing direction", [](P p) { p.landmarks[0].viewing_direction.z() = -2; }},
      {"its distances", [](P p) { p.landmarks[0].min_distance_m = -1; }},
      {"its distances", [](P p) { p.landmarks[0].max_distance_m = kNaN; }},
      {"how often", [](P p) { p.landmarks[0].times_found = -1; }},
      {"its observations", [](P p) { p.landmarks[0].observations.clear(); }},
      {"its observations", [](P p) { p.landmarks[0].observations[0].feature = 12; }},
      {"its observations", [](P p) { p.landmarks[0].observations[0].keyframe = KeyframeId(2); }},
      {"its observations",
       [](P p) { p.landmarks[0].observations.push_back(p.landmarks[0].observations.back()); }},
      {"sees two landmarks",
       [](P p) { p.landmarks[0].observations = p.landmarks[1].observations; }},
  });
}

TEST(MapParts, RigidMeansARotationAndAPlace) {
  std::mt19937 rng(3);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_rigid(random_pose(rng)));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_rigid(T));
  T(0, 0) = -1;  // a mirror
  EXPECT_FALSE(is_rigid(T));
}

}  // namespace
}  // namespace stillmap
