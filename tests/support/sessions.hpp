// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "stillmap/session/session.hpp"
#include "tests/support/random_map.hpp"
#include "tests/support/same_map.hpp"

namespace stillmap {

struct TestSessionSize {
  int keyframes = 6;  ///< ever; at least 5, two of which are dropped
  std::uint32_t features = kFeaturesPerKeyframe;
  int operations = 150;  ///< on the map's landmarks; with fewer features, each has a landmark
  int frames = 9;
  int points = 5;  ///< of a view
};

namespace test_session_detail {

inline float number(std::mt19937& rng) {
  return static_cast<float>(coordinate(rng));
}

inline CameraModel camera() {
  CameraModel camera = builtin_camera("tum_fr1");
  camera.width_px = 33;
  camera.height_px = 20;
  camera.readout_s = 0.01;
  return camera;
}

inline Keyframe keyframe(const TestSessionSize& size, std::mt19937& rng) {
  Features features;
  for (std::uint32_t i = 0; i < size.features; ++i) {
    features.raw_px.emplace_back(number(rng) + 9, number(rng) + 9);
    features.ideal_px.emplace_back(number(rng) + 9, number(rng) + 9);
    features.px.emplace_back(9 * number(rng), 5 * number(rng));
    features.sensor_depth_m.push_back(number(rng));
    features.depth_m.push_back(number(rng));
    features.level.push_back(static_cast<std::uint8_t>(pick(rng, test_scales().size())));
    features.angle_deg.push_back(number(rng));
    Descriptor descriptor{};
    for (std::uint64_t& word : descriptor) word = (std::uint64_t{rng()} << 32U) | rng();
    features.descriptors.push_back(descriptor);
  }
  features.grid = FeatureGrid(features.px, camera().width_px, camera().height_px);
  Keyframe result;
  result.frame = FrameId(pick(rng, 1000));
  result.stamp = {1305031098.25, "1305031098.2500"};
  result.T_world_camera = random_pose(rng);
  result.features = std::make_shared<const Features>(std::move(features));
  return result;
}

inline StaticView view(const TestSessionSize& size, bool whole, std::mt19937& rng) {
  StaticView view;
  PointCloud cloud;
  for (int i = 0; i < size.points; ++i) {
    cloud.positions.push_back(random_point(rng).cast<float>());
    cloud.colors.push_back({static_cast<std::uint8_t>(rng() % 256), 2, 255});
    if (whole) cloud.labels.push_back(static_cast<std::uint8_t>(rng() % 256));
  }
  view.cloud = compact(cloud);
  if (!whole) return view;
  view.range = {8, 5, 3, {}};
  for (int i = 0; i < 15; ++i) view.range.cells.emplace_back(number(rng) + 2.5F, i % 4 == 0);
  return view;
}

inline Map map(const TestSessionSize& size, std::mt19937& rng) {
  Map map(test_scales());
  for (int i = 0; i < size.keyframes; ++i) {
    Keyframe next = keyframe(size, rng);
    next.submap = SubmapId(i < 4 ? 0 : 2);
    map.add_keyframe(std::move(next));
  }
  if (size.features >= kFeaturesPerKeyframe) {  // the operations name features up to this number
    for (int i = 0; i < size.operations; ++i) random_operation(map, {}, rng)(map);
  } else {
    for (std::uint32_t i = 0; i < size.features; ++i) {
      const LandmarkId id = map.add_landmark(random_point(rng), {KeyframeId(0), i});
      map.add_observation(id, {KeyframeId(1 + i % 4), i});
      map.refresh(id);
    }
  }
  map.remove_keyframe(KeyframeId(3), KeyframeId(2));
  map.remove_keyframe(KeyframeId(2), KeyframeId(1));
  for (const LandmarkId id : map.landmark_ids()) {
    for (std::uint32_t i = pick(rng, 4); i > 0; --i) map.count_expected(id);
    for (std::uint32_t i = pick(rng, 3); i > 0; --i) map.count_found(id);
  }
  return map;
}

}  // namespace test_session_detail

/// A session with every kind of content: two submaps, dropped key frames fixed to others, landmarks
/// with several observations, views with and without labels and range.
[[nodiscard]] inline Session random_session(std::uint32_t seed, const TestSessionSize& size = {}) {
  std::mt19937 rng(seed);
  Session session{test_session_detail::camera(),
                  "seed: 3\ntracking:\n  features: 12\n",
                  test_session_detail::map(size, rng),
                  {},
                  {},
                  {}};
  session.loops.push_back({KeyframeId(0), KeyframeId(1), random_pose(rng), 0.01, 0.003});
  session.loops.push_back({KeyframeId(3), KeyframeId(4), random_pose(rng), 0.25, 0.125});
  for (int i = 0; i < size.frames; ++i) {
    const std::string text = i % 3 == 0 ? "" : std::to_string(i) + ".500";
    session.frames.push_back({{i + 0.5, text},
                              KeyframeId(pick(rng, static_cast<std::size_t>(size.keyframes))),
                              random_pose(rng)});
    if (i % 3 != 1) continue;
    session.views.push_back(
        {static_cast<std::uint32_t>(i),
         std::make_shared<const StaticView>(test_session_detail::view(size, i % 2 == 0, rng))});
  }
  for (std::uint32_t track : {2U, 5U}) {
    KnownObject object;
    object.track = TrackId(track);
    object.class_name = track == 2 ? "chair" : "";
    object.seen_s = 12.5;
    object.sightings = 7;
    if (track == 2) {
      object.surface = {random_point(rng), random_point(rng)};
      object.extent.extend(random_point(rng));
      object.extent.extend(random_point(rng));
      object.extent_area_m2 = 0.5;
      object.colors[3] = 1;
    }
    session.objects.push_back(std::move(object));
  }
  return session;
}

inline void expect_same(const KnownObject& a, const KnownObject& b) {
  EXPECT_EQ(a.track, b.track);
  EXPECT_EQ(a.class_name, b.class_name);
  EXPECT_EQ(a.seen_s, b.seen_s);
  EXPECT_EQ(a.sightings, b.sightings);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.extent.min(), b.extent.min());
  EXPECT_EQ(a.extent.max(), b.extent.max());
  EXPECT_EQ(a.extent_area_m2, b.extent_area_m2);
  EXPECT_EQ(a.colors, b.colors);
}

inline void expect_same(const CameraModel& a, const CameraModel& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  for (double CameraModel::*number : {&CameraModel::fx,
                                      &CameraModel::fy,
                                      &CameraModel::cx,
                                      &CameraModel::cy,
                                      &CameraModel::k1,
                                      &CameraModel::k2,
                                      &CameraModel::p1,
                                      &CameraModel::p2,
                                      &CameraModel::k3,
                                      &CameraModel::k4,
                                      &CameraModel::k5,
                                      &CameraModel::k6,
                                      &CameraModel::depth_factor,
                                      &CameraModel::readout_s}) {
    EXPECT_EQ(a.*number, b.*number);
  }
  EXPECT_EQ(a.lens, b.lens);
}

inline void expect_same(const StaticView& a, const StaticView& b) {
  EXPECT_EQ(a.cloud.origin, b.cloud.origin);
  EXPECT_EQ(a.cloud.step, b.cloud.step);
  EXPECT_EQ(a.cloud.places, b.cloud.places);
  EXPECT_EQ(a.cloud.colors, b.cloud.colors);
  EXPECT_EQ(a.cloud.labels, b.cloud.labels);
  EXPECT_EQ(a.range.block_px, b.range.block_px);
  EXPECT_EQ(a.range.columns, b.range.columns);
  EXPECT_EQ(a.range.rows, b.range.rows);
  ASSERT_EQ(a.range.cells.size(), b.range.cells.size());
  for (std::size_t i = 0; i < a.range.cells.size(); ++i) {
    EXPECT_EQ(a.range.cells[i].range_m(), b.range.cells[i].range_m());
    EXPECT_EQ(a.range.cells[i].moving(), b.range.cells[i].moving());
  }
}

/// All but the views.
inline void expect_same_without_views(const Session& a, const Session& b) {
  expect_same(a.camera, b.camera);
  EXPECT_EQ(a.config_yaml, b.config_yaml);
  expect_same(a.map.parts(), b.map.parts());
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    EXPECT_EQ(a.loops[i].a, b.loops[i].a);
    EXPECT_EQ(a.loops[i].b, b.loops[i].b);
    EXPECT_EQ(a.loops[i].T_a_b.matrix(), b.loops[i].T_a_b.matrix());
    EXPECT_EQ(a.loops[i].sigma_m, b.loops[i].sigma_m);
    EXPECT_EQ(a.loops[i].sigma_rad, b.loops[i].sigma_rad);
  }
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].stamp.seconds, b.frames[i].stamp.seconds);
    EXPECT_EQ(a.frames[i].stamp.text, b.frames[i].stamp.text);
    EXPECT_EQ(a.frames[i].reference, b.frames[i].reference);
    EXPECT_EQ(a.frames[i].T_reference_frame.matrix(), b.frames[i].T_reference_frame.matrix());
  }
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) expect_same(a.objects[i], b.objects[i]);
}

/// Expects two sessions to be equal in every field.
inline void expect_same(const Session& a, const Session& b) {
  expect_same_without_views(a, b);
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].frame, b.views[i].frame);
    EXPECT_EQ(a.views[i].depth_after_color_s, b.views[i].depth_after_color_s);
    expect_same(*a.views[i].view, *b.views[i].view);
  }
}

}  // namespace stillmap
