// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_map.hpp"

#include <algorithm>
#include <map>

namespace stillmap {

Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame) {
  return session.map.T_world_keyframe(frame.reference) * frame.T_reference_frame;
}

WorldId world_of(const Session& session, const FrameRecord& frame) {
  return session.map.keyframe(session.map.anchor(frame.reference).keyframe).world;
}

WorldId main_world(const Session& session, std::size_t first_frame) {
  std::map<WorldId, std::size_t> frames;
  for (std::size_t i = first_frame; i < session.frames.size(); ++i) {
    ++frames[world_of(session, session.frames[i])];
  }
  // The first of the greatest, and the map is sorted.
  const auto most = std::ranges::max_element(
      frames, {}, [](const std::pair<const WorldId, std::size_t>& entry) { return entry.second; });
  return most == frames.end() ? WorldId{} : most->first;
}

Trajectory trajectory_in(const Session& session, WorldId world, std::size_t first_frame) {
  Trajectory trajectory;
  for (std::size_t i = first_frame; i < session.frames.size(); ++i) {
    const FrameRecord& frame = session.frames[i];
    if (world_of(session, frame) != world) continue;
    trajectory.push_back({frame.stamp, T_world_frame(session, frame)});
  }
  return trajectory;
}

Trajectory keyframes_in(const Session& session, WorldId world) {
  Trajectory trajectory;
  for (const auto& [id, keyframe] : session.map.keyframes()) {
    if (keyframe.world == world) trajectory.push_back({keyframe.stamp, keyframe.T_world_camera});
  }
  return trajectory;
}

}  // namespace stillmap
