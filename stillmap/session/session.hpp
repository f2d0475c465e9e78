// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/object_identities.hpp"
#include "stillmap/session/frame_records.hpp"
#include "stillmap/slam/loop/loop_match.hpp"
#include "stillmap/slam/map/map.hpp"

namespace stillmap {

/// The view of a recorded frame.
struct ViewRecord {
  std::uint32_t frame = 0;                 ///< index of its record
  std::shared_ptr<const StaticView> view;  ///< not null in a finished session
  /// When its depth was taken, after the frame's colour image: the view's pose is that of then.
  double depth_after_color_s = 0;
};

/// The state of a run that can be saved, continued and merged.
struct Session {
  CameraModel camera;
  std::string config_yaml;  ///< the settings of the run
  Map map = Map({});
  std::vector<LoopEdge> loops;
  FrameRecords frames;            ///< in the order of tracking
  std::vector<ViewRecord> views;  ///< by frame, ascending
  /// By track, in the world frame of the submap with most of the frames.
  std::vector<KnownObject> objects = {};
};

}  // namespace stillmap
