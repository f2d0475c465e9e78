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

/// The result of the adjustment of a whole submap, for the key frames and landmarks present when it
/// began.
struct GlobalCorrection {
  std::map<KeyframeId, Eigen::Isometry3d> T_world_camera;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
  std::vector<std::pair<LandmarkId, KeyframeId>> outliers;  ///< observations that do not fit
};

/// A separate map of everything in a submap.
[[nodiscard]] Map submap_window(const Map& map, SubmapId submap);

/// Bundle adjustment of all key frames and landmarks of a submap; `window` is its submap_window().
/// Shares nothing with the owner of the map and may run on any thread.
[[nodiscard]] GlobalCorrection adjust_globally(Map window,
                                               const CameraModel& camera,
                                               const MeasurementModel& measure,
                                               const BundleConfig& config);

/// Applies a correction to the map, which has changed meanwhile. Newer key frames move with the
/// corrected key frame that shares most landmarks with them, newer landmarks with the key frame
/// that created them. `map` is the whole map; no window of it may be in work.
void apply_correction(Map& map, const GlobalCorrection& correction);

}  // namespace stillmap
