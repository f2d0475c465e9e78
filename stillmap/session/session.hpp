// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/loop/loop_match.hpp"
#include "stillmap/slam/map/map.hpp"

namespace stillmap {

/// A tracked frame's pose, held relative to a key frame (which may have been dropped since) so that
/// later optimisation reaches it.
struct FrameRecord {
  Stamp stamp;
  KeyframeId reference;
  Eigen::Isometry3d T_reference_frame = Eigen::Isometry3d::Identity();
};

/// A frame's part of the dense map.
struct ViewRecord {
  std::uint32_t frame = 0;                 ///< index of its record
  std::shared_ptr<const StaticView> view;  ///< not null in a finished session
};

/// All that a run knows of where it has been: what is saved, continued and merged.
struct Session {
  CameraModel camera;
  std::string config_yaml;  ///< the settings that it was made with
  Map map = Map({});
  std::vector<LoopEdge> loops;
  std::vector<FrameRecord> frames;  ///< in the order in which they were tracked
  std::vector<ViewRecord> views;    ///< by frame, ascending
};

}  // namespace stillmap
