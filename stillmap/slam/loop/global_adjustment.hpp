// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// What the adjustment of a whole submap says of what was in the map when it began.
struct GlobalCorrection {
  std::map<KeyframeId, Eigen::Isometry3d> T_world_camera;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
  std::vector<std::pair<LandmarkId, KeyframeId>> outliers;  ///< observations that do not fit
};

/// A map of its own of all that is in a submap.
[[nodiscard]] Map submap_window(const Map& map, SubmapId submap);

/// Bundle adjustment of all key frames and landmarks of a submap (`window` is its submap_window()).
/// Shares nothing with the map's owner; may run on any thread.
[[nodiscard]] GlobalCorrection adjust_globally(Map window,
                                               const CameraModel& camera,
                                               const MeasurementModel& measure,
                                               const BundleConfig& config);

/// Brings a correction into the map, which has gone on meanwhile: key frames that have come since
/// move with the corrected one that shares most landmarks with them, landmarks that have come since
/// with the key frame that made them. `map` is the whole map, with no window of it being worked on.
void apply_correction(Map& map, const GlobalCorrection& correction);

}  // namespace stillmap
