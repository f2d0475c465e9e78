// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/mapping/culling.hpp"
#include "stillmap/slam/mapping/landmark_creation.hpp"
#include "stillmap/slam/mapping/landmark_fusion.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

struct MappingConfig {
  int lag_frames = 6;
  int window_keyframes = 20;
  LandmarkFusionConfig fusion;
  LandmarkCreationConfig creation;
  CullingConfig culling;
  BundleConfig bundle;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lag_frames",
          self.lag_frames,
          FieldInfo{"a key frame's mapping reaches the map that many frames after it; at most "
                    "keyframe.min_gap_frames",
                    "frames",
                    0,
                    1000});
    visit("window_keyframes",
          self.window_keyframes,
          FieldInfo{"key frames that local bundle adjustment moves", "", 2, 200});
    LandmarkFusionConfig::fields(self.fusion, visit);
    visit.group("creation", self.creation);
    visit.group("culling", self.culling);
    visit.group("bundle", self.bundle);
  }
};

/// The key frames whose surroundings a new key frame changes: itself and those that share most
/// landmarks with it. The new one is first.
[[nodiscard]] std::vector<KeyframeId> mapping_core(const Map& map,
                                                   KeyframeId newest,
                                                   const MappingConfig& config);

/// What a new key frame means for the map round it: landmarks are culled, triangulated and fused
/// with those of its neighbours, poses and points adjusted, redundant key frames dropped. `window`
/// is map.window(core); the job shares nothing with its owner and may run on any thread.
[[nodiscard]] MapUpdate map_locally(Map window,
                                    const std::vector<KeyframeId>& core,
                                    const CameraModel& camera,
                                    const MeasurementModel& measure,
                                    const MappingConfig& config);

}  // namespace stillmap
