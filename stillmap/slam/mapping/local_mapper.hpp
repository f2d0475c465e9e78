// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/mapping/camera_times.hpp"
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
    visit(
        "lag_frames",
        self.lag_frames,
        common_setting(FieldInfo{
            "number of frames after which a map update is applied; at most keyframe.min_gap_frames",
            "frames",
            0,
            1000}));
    visit("window_keyframes",
          self.window_keyframes,
          common_setting(
              FieldInfo{"number of key frames that local bundle adjustment moves", "", 2, 200}));
    LandmarkFusionConfig::fields(self.fusion, visit);
    visit.group("creation", self.creation);
    visit.group("culling", self.culling);
    visit.group("bundle", self.bundle);
  }
};

/// The core of the window of a new key frame: itself, first, and the key frames that share most
/// landmarks with it.
[[nodiscard]] std::vector<KeyframeId> mapping_core(const Map& map,
                                                   KeyframeId newest,
                                                   const MappingConfig& config);

/// What local mapping found.
struct MappingResult {
  MapUpdate update;
  TimeEvidence times;
};

/// Local mapping around a new key frame: corrects the features of the core for the camera's times,
/// culls, triangulates and fuses landmarks with those of its
/// neighbours, adjusts poses and points, and drops redundant key frames. `window` is
/// map.window(core). The job shares nothing with the owner of the map and may run on any thread.
[[nodiscard]] MappingResult map_locally(Map window,
                                        const std::vector<KeyframeId>& core,
                                        const CameraModel& camera,
                                        const CameraTimes& times,
                                        const MeasurementModel& measure,
                                        const MappingConfig& config);

}  // namespace stillmap
