// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/local_mapper.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/tracking/keyframe_policy.hpp"
#include "stillmap/slam/tracking/tracker.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr ObservationNoise kCoarseNoise{.pixel_sigma_px = 0.5,
                                        .inverse_depth_sigma = 0.01,
                                        .missing_depth_share = 0.2,
                                        .flipped_bits = 10};

MeasurementModel coarse_model() {
  return MeasurementModel({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                          simulated_world().level_scales());
}

Eigen::Isometry3d along(double s) {
  return make_pose(so3_exp(Eigen::Vector3d(0.05 * std::sin(s), 0.5 * std::sin(0.7 * s), 0)),
                   Eigen::Vector3d(0.8 * std::sin(s), 0.2 * std::sin(1.7 * s), 0.3 * std::sin(s)));
}

TEST(MappingCore, IsTheNewestAndThoseThatShareMost) {
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 9; ++k) poses.push_back(along(0.15 * k));
  std::mt19937 rng(1);
  const SimulatedMap simulated = make_true_map(simulated_world(), poses, kCoarseNoise, rng);
  MappingConfig config;
  config.window_keyframes = 5;
  const std::vector<KeyframeId> core = mapping_core(simulated.map, KeyframeId(8), config);
  ASSERT_EQ(core.size(), 5U);
  EXPECT_EQ(core[0], KeyframeId(8));
  const std::vector<CovisibleKeyframe> covisible =
      covisible_keyframes(simulated.map, KeyframeId(8));
  for (std::size_t i = 1; i < core.size(); ++i) EXPECT_EQ(core[i], covisible[i - 1].id);
}

// Key frames at slightly wrong poses; each made landmarks of its own from depth, at wrong places.
SimulatedMap rough_map(int keyframes) {
  SimulatedMap simulated(simulated_world());
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < keyframes; ++k) {
    const Eigen::Isometry3d truth = along(0.12 * k);
    const KeyframeId id =
        add_bare_keyframe(simulated, truth, simulated_world().observe(truth, kCoarseNoise, rng));
    const std::vector<std::uint32_t>& points = simulated.points[id.index()];
    // What tracking would have found: nine tenths of the known points.
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const auto known = simulated.landmark_of_point.find(points[i]);
      if (known != simulated.landmark_of_point.end() && rng() % 10U != 0U) {
        simulated.map.add_observation(known->second, {id, i});
      }
    }
    if (k > 0) {
      const Eigen::Vector3d turn(normal(rng), normal(rng), normal(rng));
      const Eigen::Vector3d shift(normal(rng), normal(rng), normal(rng));
      simulated.map.set_pose(id, truth * make_pose(so3_exp(0.005 * turn), 0.02 * shift));
    }
    create_landmarks_from_depth(simulated.map, id, simulated_world().camera(), coarse_model(), {});
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const LandmarkId landmark = simulated.map.keyframe(id).landmarks[i];
      if (landmark.valid()) simulated.landmark_of_point.try_emplace(points[i], landmark);
    }
  }
  for (const LandmarkId id : simulated.map.landmark_ids()) simulated.map.refresh(id);
  return simulated;
}

double keyframe_rmse_m(const SimulatedMap& simulated) {
  double sum = 0;
  const std::size_t count = simulated.T_world_keyframe.size();
  for (std::uint32_t k = 0; k < count; ++k) {
    sum += (simulated.map.T_world_keyframe(KeyframeId(k)).translation() -
            simulated.T_world_keyframe[k].translation())
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(count));
}

// Of some points: landmarks that are seen as two of them, and landmarks beyond one of each.
struct Purity {
  int mixed = 0;
  int duplicates = 0;
};

Purity purity_of(const SimulatedMap& simulated, const std::vector<std::uint32_t>& points) {
  const std::set<std::uint32_t> asked(points.begin(), points.end());
  Purity purity;
  std::set<std::uint32_t> known;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    const std::uint32_t point = true_point(simulated, landmark);
    if (!asked.contains(point)) continue;
    const bool mixed = std::ranges::any_of(landmark.observations, [&](const Observation& o) {
      return simulated.points[o.keyframe.index()][o.feature] != point;
    });
    purity.mixed += mixed ? 1 : 0;
    purity.duplicates += known.insert(point).second ? 0 : 1;
  }
  return purity;
}

// Landmarks that no key frame knows the depth of.
int without_depth(const Map& map) {
  int count = 0;
  for (const LandmarkId id : map.landmark_ids()) {
    count += std::ranges::none_of(map.landmark(id).observations, [&](const Observation& o) {
      return map.keyframe(o.keyframe).features->depth_m[o.feature] > 0;
    });
  }
  return count;
}

TEST(MapLocally, GivesAConsistentAndBetterMap) {
  SimulatedMap simulated = rough_map(8);
  (void)simulated.map.take_changes();
  const std::vector<std::uint32_t>& points = simulated.points[7];
  const double before_m = keyframe_rmse_m(simulated);
  const Purity before = purity_of(simulated, points);
  ASSERT_GT(before.duplicates, 50);
  ASSERT_EQ(without_depth(simulated.map), 0);
  // Twice: some are fused only after the first adjustment has brought them together.
  for (int round = 0; round < 2; ++round) {
    const MappingConfig config;
    const std::vector<KeyframeId> core = mapping_core(simulated.map, KeyframeId(7), config);
    simulated.map.apply(map_locally(simulated.map.window(core),
                                    core,
                                    simulated_world().camera(),
                                    {},
                                    coarse_model(),
                                    config)
                            .update);
    simulated.map.check_consistency();
  }
  EXPECT_LT(keyframe_rmse_m(simulated), 0.3 * before_m);
  const Purity after = purity_of(simulated, points);
  EXPECT_LT(after.duplicates, before.duplicates / 4);
  EXPECT_EQ(after.mixed, 0);
  EXPECT_GT(without_depth(simulated.map), 0);  // triangulated
}

TEST(MapLocally, IsTheSameForTheSameWindow) {
  const SimulatedMap simulated = rough_map(6);
  MappingConfig config;
  const std::vector<KeyframeId> core = mapping_core(simulated.map, KeyframeId(5), config);
  const auto run = [&] {
    return map_locally(simulated.map.window(core),
                       core,
                       simulated_world().camera(),
                       {},
                       coarse_model(),
                       config)
        .update;
  };
  const MapUpdate a = run(), b = run();
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t i = 0; i < a.landmarks.size(); ++i) {
    EXPECT_EQ(a.landmarks[i].p_world, b.landmarks[i].p_world);
    EXPECT_EQ(a.landmarks[i].observations, b.landmarks[i].observations);
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    EXPECT_EQ(a.keyframes[i].T_world_camera.matrix(), b.keyframes[i].T_world_camera.matrix());
  }
  EXPECT_EQ(a.merged_landmarks, b.merged_landmarks);
  EXPECT_EQ(a.removed_landmarks, b.removed_landmarks);
}

// Tracking and mapping together, as the system joins them, on features instead of images.
class SmallSlam {
 public:
  explicit SmallSlam(const ShutterConfig& config = {})
      : simulated_(simulated_world()),
        tracker_({}, {}, simulated_world().camera(), coarse_model(), 0),
        times_(config, simulated_world().camera()) {}

  TrackedFrame process(std::uint32_t k, double time_s, const Observed& seen) {
    if (pending_ && k == due_) apply_pending();
    RgbdFrame frame;
    frame.id = FrameId(k);
    frame.stamp.seconds = time_s;
    TrackedFrame tracked =
        k == 0 ? tracker_.start(frame, std::make_shared<const Features>(seen.features))
               : tracker_.track(frame, seen.features, simulated_.map, PlaceIndex());
    if (k > 0 && has_pose(tracked)) count(tracked);
    since_keyframe_.most_inliers = std::max(since_keyframe_.most_inliers, tracked.inliers);
    ++since_keyframe_.frames;
    if (k == 0 || wants_keyframe({}, tracked, since_keyframe_, simulated_.map))
      insert(k, tracked, seen);
    return tracked;
  }

  [[nodiscard]] const SimulatedMap& simulated() const { return simulated_; }
  [[nodiscard]] double readout_s() const { return times_.times().readout_s; }

 private:
  void count(const TrackedFrame& tracked) {
    for (const LandmarkId id : tracked.expected) simulated_.map.count_expected(id);
    for (const LandmarkId id : tracked.landmarks) {
      if (id.valid()) simulated_.map.count_found(id);
    }
  }

  void insert(std::uint32_t k, const TrackedFrame& tracked, const Observed& seen) {
    Observed as_tracked{*tracked.features, seen.points};
    const KeyframeId id =
        add_bare_keyframe(simulated_, tracked.T_world_camera, std::move(as_tracked));
    simulated_.map.set_features(id, tracked.features, tracked.timing);
    for (std::uint32_t i = 0; i < tracked.landmarks.size(); ++i) {
      if (!tracked.landmarks[i].valid()) continue;
      simulated_.map.add_observation(tracked.landmarks[i], {id, i});
      simulated_.map.refresh(tracked.landmarks[i]);
    }
    create_landmarks_from_depth(simulated_.map, id, simulated_world().camera(), coarse_model(), {});
    (void)simulated_.map.take_changes();
    tracker_.set_reference(id, simulated_.map);
    const std::vector<KeyframeId> core = mapping_core(simulated_.map, id, {});
    pending_ = map_locally(simulated_.map.window(core),
                           core,
                           simulated_world().camera(),
                           times_.times(),
                           coarse_model(),
                           {});
    due_ = k + 3;
    since_keyframe_ = {};
  }

  void apply_pending() {
    simulated_.map.apply(pending_->update);
    times_.add(pending_->times);
    tracker_.assume(times_.times());
    pending_.reset();
    simulated_.map.check_consistency();
  }

  SimulatedMap simulated_;
  Tracker tracker_;
  CameraTimesEstimator times_;
  std::optional<MappingResult> pending_;
  std::uint32_t due_ = 0;
  KeyframeAge since_keyframe_;
};

// Swings about, looking at most of the room.
Eigen::Isometry3d looking_about(double t) {
  return make_pose(
      so3_exp(Eigen::Vector3d(0.2 * std::sin(0.9 * t), 1.4 * std::sin(0.5 * t), 0)),
      Eigen::Vector3d(0.6 * std::sin(0.7 * t), 0.2 * std::sin(1.1 * t), 0.4 * std::sin(0.6 * t)));
}

// Errors of the poses of the first 30 s.
struct FollowErrors {
  double worst_m = 0;
  double late_rmse_m = 0;  // of the last ten seconds
};

FollowErrors follow(SmallSlam& slam, double readout_s) {
  std::mt19937 rng(9);
  FollowErrors errors;
  for (std::uint32_t k = 0; k < 900; ++k) {
    const double time_s = k / 30.0;
    const TrackedFrame tracked = slam.process(
        k,
        time_s,
        simulated_world().observe_rolling(looking_about, time_s, readout_s, kCoarseNoise, rng));
    EXPECT_TRUE(has_pose(tracked)) << k;
    if (!has_pose(tracked)) break;
    const double error_m =
        (tracked.T_world_camera.translation() - looking_about(time_s).translation()).norm();
    errors.worst_m = std::max(errors.worst_m, error_m);
    if (k >= 600) errors.late_rmse_m += error_m * error_m / 300;
  }
  errors.late_rmse_m = std::sqrt(errors.late_rmse_m);
  return errors;
}

TEST(MapLocally, WithTrackingBuildsATrueMapOfARoom) {
  SmallSlam slam;
  EXPECT_LT(follow(slam, 0).worst_m, 0.02);
  std::vector<std::uint32_t> all(simulated_world().points().size());
  std::iota(all.begin(), all.end(), 0U);
  const Purity purity = purity_of(slam.simulated(), all);
  const auto landmarks = static_cast<double>(slam.simulated().map.landmark_count());
  EXPECT_GT(landmarks, 1500);
  EXPECT_LT(purity.mixed, 0.002 * landmarks);
  EXPECT_LT(purity.duplicates, 0.1 * landmarks);
  EXPECT_LT(slam.simulated().map.keyframes().size(), slam.simulated().points.size());
}

TEST(MapLocally, WithTrackingLearnsARollingShutterWhileTheMapGrows) {
  ShutterConfig on, off;
  off.calibrate = false;
  SmallSlam learning(on), ignorant(off);
  const FollowErrors with = follow(learning, 0.025), without = follow(ignorant, 0.025);
  EXPECT_NEAR(learning.readout_s(), 0.025, 3e-3);
  EXPECT_LT(with.late_rmse_m, 0.7 * without.late_rmse_m);
}

TEST(MapLocally, WithTrackingFindsNoRollingShutterWhereThereIsNone) {
  SmallSlam slam;
  (void)follow(slam, 0);
  EXPECT_EQ(slam.readout_s(), 0);
}

}  // namespace
}  // namespace stillmap
