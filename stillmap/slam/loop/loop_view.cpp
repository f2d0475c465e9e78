// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_view.hpp"

namespace stillmap {

LoopView loop_view(const Keyframe& keyframe,
                   const Map& map,
                   const CameraModel& camera,
                   const MeasurementModel& measure) {
  const Features& features = *keyframe.features;
  const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
  LoopView view{keyframe.features, {}, keyframe.id};
  view.p_camera.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Landmark* landmark =
        i < keyframe.landmarks.size() ? map.find(keyframe.landmarks[i]) : nullptr;
    if (landmark != nullptr) {
      view.p_camera[i] = T_camera_world * landmark->p_world;
    } else if (measure.has_depth(features, i)) {
      view.p_camera[i] =
          camera.unproject(features.px[i].cast<double>(), static_cast<double>(features.depth_m[i]));
    }
  }
  return view;
}

}  // namespace stillmap
