// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// A part of a map as a bundle.
struct MapProblem {
  BundleProblem problem;
  std::vector<KeyframeId> keyframes;    ///< per camera
  std::vector<LandmarkId> landmarks;    ///< per point
  std::vector<std::uint32_t> features;  ///< per observation
};

/// The bundle of all landmarks that a key frame of `free` observes. All other key frames, and
/// origins, are held.
[[nodiscard]] MapProblem make_problem(const Map& map,
                                      const std::set<KeyframeId>& free,
                                      const CameraModel& camera,
                                      const MeasurementModel& measure);

}  // namespace stillmap
