// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/slam/map/map_parts.hpp"

namespace stillmap {

// Expects two maps to be equal in every field.

/// The grids are compared by the results of queries.
inline void expect_same(const Features& a, const Features& b) {
  EXPECT_EQ(a.raw_px, b.raw_px);
  EXPECT_EQ(a.ideal_px, b.ideal_px);
  EXPECT_EQ(a.px, b.px);
  EXPECT_EQ(a.sensor_depth_m, b.sensor_depth_m);
  EXPECT_EQ(a.depth_m, b.depth_m);
  EXPECT_EQ(a.level, b.level);
  EXPECT_EQ(a.angle_deg, b.angle_deg);
  EXPECT_EQ(a.descriptors, b.descriptors);
  for (const Eigen::Vector2f& px : a.px) {
    std::vector<std::uint32_t> near_a, near_b;
    a.grid.visit_near(px, 20.0F, [&](std::uint32_t i) { near_a.push_back(i); });
    b.grid.visit_near(px, 20.0F, [&](std::uint32_t i) { near_b.push_back(i); });
    EXPECT_EQ(near_a, near_b);
  }
}

inline void expect_same(const Keyframe& a, const Keyframe& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.stamp.text, b.stamp.text);
  EXPECT_EQ(a.stamp.seconds, b.stamp.seconds);
  EXPECT_EQ(a.submap, b.submap);
  EXPECT_EQ(a.is_origin, b.is_origin);
  EXPECT_EQ(a.T_world_camera.matrix(), b.T_world_camera.matrix());
  expect_same(*a.features, *b.features);
  EXPECT_EQ(a.landmarks, b.landmarks);
}

inline void expect_same(const Landmark& a, const Landmark& b) {
  EXPECT_EQ(a.id, b.id);
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

inline void expect_same(const MapParts& a, const MapParts& b) {
  EXPECT_EQ(a.level_scales, b.level_scales);
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    expect_same(a.keyframes[i], b.keyframes[i]);
  }
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t i = 0; i < a.landmarks.size(); ++i) {
    expect_same(a.landmarks[i], b.landmarks[i]);
  }
  ASSERT_EQ(a.dropped_keyframes.size(), b.dropped_keyframes.size());
  for (std::size_t i = 0; i < a.dropped_keyframes.size(); ++i) {
    EXPECT_EQ(a.dropped_keyframes[i].first, b.dropped_keyframes[i].first);
    EXPECT_EQ(a.dropped_keyframes[i].second.keyframe, b.dropped_keyframes[i].second.keyframe);
    EXPECT_EQ(a.dropped_keyframes[i].second.T_anchor_dropped.matrix(),
              b.dropped_keyframes[i].second.T_anchor_dropped.matrix());
  }
  EXPECT_EQ(a.next_keyframe, b.next_keyframe);
  EXPECT_EQ(a.next_landmark, b.next_landmark);
}

}  // namespace stillmap
