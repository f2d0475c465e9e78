// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/dense/static_map.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"
#include "stillmap/slam/loop/loop_config.hpp"
#include "stillmap/slam/mapping/local_mapper.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/tracking/keyframe_policy.hpp"
#include "stillmap/slam/tracking/relocalizer.hpp"
#include "stillmap/slam/tracking/tracker.hpp"

namespace stillmap {

/// Settings of features and tracking, which share the group `tracking`.
struct TrackingConfig {
  OrbConfig orb;
  TrackerConfig tracker;
  ShutterConfig shutter;
  bool smooth = true;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OrbConfig::fields(self.orb, visit);
    TrackerConfig::fields(self.tracker, visit);
    visit.group("shutter", self.shutter);
    visit("smooth",
          self.smooth,
          FieldInfo{"whether the trajectory is smoothed at the end of a run, by each frame's "
                    "information and the camera's likely acceleration"});
  }
};

/// Settings of live runs.
struct LiveConfig {
  int look_gap_frames = 3;
  int look_rest_frames = 10;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "look_gap_frames",
        self.look_gap_frames,
        common_setting(FieldInfo{
            "least number of frames between two frames given to the network in a live run; 1 when "
            "something comes into view or somebody is seen first",
            "frames",
            1,
            1000}));
    visit("look_rest_frames",
          self.look_rest_frames,
          FieldInfo{"that number while nothing moves", "frames", 1, 1000});
  }
};

/// All settings of a system, with their defaults.
struct SystemConfig {
  std::uint32_t seed = 0;
  TrackingConfig tracking;
  MeasurementConfig measurement;
  DynamicsConfig dynamics;
  KeyframePolicyConfig keyframe;
  RelocalizerConfig relocalization;
  MappingConfig mapping;
  LoopConfig loop;
  CloudConfig cloud;
  LiveConfig live;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("seed", self.seed, common_setting(FieldInfo{"seed of all random choices (RANSAC)"}));
    visit.group("tracking", self.tracking);
    visit.group("measurement", self.measurement);
    visit.group("dynamics", self.dynamics);
    visit.group("keyframe", self.keyframe);
    visit.group("relocalization", self.relocalization);
    visit.group("mapping", self.mapping);
    visit.group("loop", self.loop);
    visit.group("cloud", self.cloud);
    visit.group("live", self.live);
  }

  /// Checks the rules between several values. Throws Error naming the keys.
  void check() const;
};

/// The measurement model of loop verification and global adjustment. Over a loop depth must have
/// its full weight, since pixels alone hardly distinguish a step to the side from a turn. Tracking
/// gives depth less weight, because the sensor's errors are similar from frame to frame.
[[nodiscard]] MeasurementModel loop_measurement_model(const SystemConfig& config,
                                                      std::vector<float> level_scales);

}  // namespace stillmap
