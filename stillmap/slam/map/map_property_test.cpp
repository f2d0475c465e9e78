// SPDX-License-Identifier: Apache-2.0
// Properties of the map under random operations, against models that are too simple to be wrong.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "stillmap/slam/map/map.hpp"
#include "tests/support/random_map.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kSeeds = 40;

std::vector<KeyframeId> all_keyframes(const Map& map) {
  std::vector<KeyframeId> ids;
  for (const auto& [id, keyframe] : map.keyframes()) ids.push_back(id);
  return ids;
}

void expect_equal(const Landmark& a, const Landmark& b) {
  EXPECT_EQ(a.p_world, b.p_world);
  EXPECT_EQ(a.observations, b.observations);
  EXPECT_EQ(a.created_by, b.created_by);
  EXPECT_EQ(a.descriptor, b.descriptor);
  EXPECT_EQ(a.viewing_direction, b.viewing_direction);
  EXPECT_EQ(a.min_distance_m, b.min_distance_m);
  EXPECT_EQ(a.max_distance_m, b.max_distance_m);
  EXPECT_EQ(a.times_expected, b.times_expected);
  EXPECT_EQ(a.times_found, b.times_found);
}

void expect_equal(const Map& a, const Map& b, std::uint32_t keyframes_ever) {
  ASSERT_EQ(a.landmark_ids(), b.landmark_ids());
  for (const LandmarkId id : a.landmark_ids()) {
    SCOPED_TRACE(id.value);
    expect_equal(a.landmark(id), b.landmark(id));
  }
  ASSERT_EQ(all_keyframes(a), all_keyframes(b));
  for (const KeyframeId id : all_keyframes(a)) {
    EXPECT_EQ(a.keyframe(id).landmarks, b.keyframe(id).landmarks);
  }
  for (std::uint32_t k = 0; k < keyframes_ever; ++k) {
    EXPECT_EQ(a.T_world_keyframe(KeyframeId(k)).matrix(),
              b.T_world_keyframe(KeyframeId(k)).matrix());
  }
  for (std::uint32_t l = 0; l < 500; ++l) {
    EXPECT_EQ(a.resolve(LandmarkId(l)), b.resolve(LandmarkId(l)));
  }
}

TEST(MapProperty, AnyOperationsLeaveItConsistent) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 rng(seed);
    Map map = random_map(6, 0, rng);
    for (int i = 0; i < 300; ++i) {
      random_operation(map, all_keyframes(map), rng)(map);
      ASSERT_NO_THROW(map.check_consistency()) << "seed " << seed << ", operation " << i;
    }
    EXPECT_GT(map.landmark_count(), 3U);
  }
}

TEST(MapProperty, AWindowHoldsTheCoreItsLandmarksAndTheirObservers) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 rng(seed);
    const Map map = random_map(12, 120, rng);
    const std::vector<KeyframeId> core = {KeyframeId(pick(rng, 6)), KeyframeId(6 + pick(rng, 6))};
    std::set<LandmarkId> landmarks;
    std::set<KeyframeId> keyframes(core.begin(), core.end());
    for (const LandmarkId id : map.landmark_ids()) {
      for (const Observation& o : map.landmark(id).observations) {
        if (o.keyframe == core[0] || o.keyframe == core[1]) landmarks.insert(id);
      }
    }
    for (const LandmarkId id : landmarks) {
      for (const Observation& o : map.landmark(id).observations) keyframes.insert(o.keyframe);
    }
    const Map window = map.window(core);
    window.check_consistency();
    EXPECT_EQ(window.landmark_ids(), std::vector(landmarks.begin(), landmarks.end()));
    EXPECT_EQ(all_keyframes(window), std::vector(keyframes.begin(), keyframes.end()));
    for (const LandmarkId id : landmarks) expect_equal(window.landmark(id), map.landmark(id));
    for (const KeyframeId id : keyframes) {
      EXPECT_EQ(window.keyframe(id).landmarks, map.keyframe(id).landmarks);
      EXPECT_EQ(window.keyframe(id).T_world_camera.matrix(),
                map.keyframe(id).T_world_camera.matrix());
    }
  }
}

TEST(MapProperty, AWindowBeginsWithoutChanges) {
  std::mt19937 rng(1);
  Map window = random_map(5, 50, rng).window(std::vector<KeyframeId>{KeyframeId(1)});
  const MapUpdate update = window.take_changes();
  EXPECT_TRUE(update.keyframes.empty() && update.landmarks.empty());
  EXPECT_TRUE(update.removed_landmarks.empty() && update.merged_landmarks.empty());
}

// `owner` works through a window, `direct` does the same operations itself; tracking counts on both
// between cutting the window and applying its changes.
void work_in_window(Map& owner, Map& direct, std::mt19937& rng) {
  std::vector<KeyframeId> core;
  for (const KeyframeId id : all_keyframes(owner)) {
    if (pick(rng, 3) == 0) core.push_back(id);
  }
  if (core.empty()) return;
  Map window = owner.window(core);
  for (const LandmarkId id : owner.landmark_ids()) {
    for (std::uint32_t n = pick(rng, 3); n > 0; --n) {
      for (Map* map : {&owner, &direct}) map->count_expected(id);
    }
    if (pick(rng, 2) == 0) {
      for (Map* map : {&owner, &direct}) map->count_found(id);
    }
  }
  for (int i = 0; i < 40; ++i) {
    const MapOperation operation = random_operation(window, core, rng);
    operation(window);
    operation(direct);
    window.check_consistency();
  }
  owner.apply(window.take_changes());
}

TEST(MapProperty, WorkInWindowsGivesWhatTheSameWorkOnTheOwnerGives) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 rng(seed);
    Map owner = random_map(10, 150, rng);
    Map direct = owner;
    for (int round = 0; round < 6; ++round) {
      work_in_window(owner, direct, rng);
      ASSERT_NO_THROW(owner.check_consistency());
      expect_equal(owner, direct, 10);
      if (testing::Test::HasFailure()) return;
    }
    const Keyframe next = random_keyframe(rng);
    EXPECT_EQ(owner.add_keyframe(next), direct.add_keyframe(next));
    const KeyframeId newest = all_keyframes(owner).back();
    EXPECT_EQ(owner.add_landmark({1, 2, 3}, {newest, 0}),
              direct.add_landmark({1, 2, 3}, {newest, 0}));
  }
}

// Who sees what, as a plain set; operations as their descriptions say.
class ObservationSet {
 public:
  void add(LandmarkId id, Observation o) {
    for (const auto& [at, landmark] : seen_) {
      if (at.first == o.keyframe && (landmark == id || at.second == o.feature)) return;
    }
    seen_[{o.keyframe, o.feature}] = id;
  }
  void remove(LandmarkId id) {
    std::erase_if(seen_, [&](const auto& entry) { return entry.second == id; });
  }
  void merge(LandmarkId gone, LandmarkId into) {
    const auto before = seen_;
    remove(gone);
    for (const auto& [at, landmark] : before) {
      if (landmark == gone) add(into, {at.first, at.second});
    }
  }
  void drop(KeyframeId keyframe) {
    std::erase_if(seen_, [&](const auto& entry) { return entry.first.first == keyframe; });
  }
  [[nodiscard]] const auto& entries() const { return seen_; }

 private:
  std::map<std::pair<KeyframeId, std::uint32_t>, LandmarkId> seen_;
};

TEST(MapProperty, ObservationsAreThoseOfAPlainSet) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 rng(seed);
    Map map = random_map(8, 0, rng);
    ObservationSet model;
    for (int i = 0; i < 300; ++i) {
      const std::vector<KeyframeId> keyframes = all_keyframes(map);
      const std::vector<LandmarkId> ids = map.landmark_ids();
      const KeyframeId keyframe = keyframes[pick(rng, keyframes.size())];
      const Observation o{keyframe, pick(rng, kFeaturesPerKeyframe)};
      const std::uint32_t kind = pick(rng, 10);
      const LandmarkId a = ids.empty() ? LandmarkId{} : ids[pick(rng, ids.size())];
      const LandmarkId b = ids.empty() ? LandmarkId{} : ids[pick(rng, ids.size())];
      if (ids.empty() || kind < 3) {
        if (map.keyframe(keyframe).landmarks[o.feature].valid()) continue;
        model.add(map.add_landmark(random_point(rng), o), o);
      } else if (kind < 7) {
        map.add_observation(a, o);
        model.add(a, o);
      } else if (kind == 7 && a != b) {
        map.merge_landmarks(a, b);
        model.merge(a, b);
      } else if (kind == 8) {
        map.remove_landmark(a);
        model.remove(a);
      } else if (kind == 9 && keyframes.size() > 3 && keyframe != KeyframeId(0) &&
                 pick(rng, 8) == 0) {
        map.remove_keyframe(keyframe, KeyframeId(0));
        model.drop(keyframe);
      }
    }
    std::map<std::pair<KeyframeId, std::uint32_t>, LandmarkId> seen;
    for (const auto& [id, keyframe] : map.keyframes()) {
      for (std::uint32_t f = 0; f < kFeaturesPerKeyframe; ++f) {
        if (keyframe.landmarks[f].valid()) seen[{id, f}] = keyframe.landmarks[f];
      }
    }
    EXPECT_EQ(seen, model.entries()) << seed;
  }
}

}  // namespace
}  // namespace stillmap
