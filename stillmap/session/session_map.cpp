// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_map.hpp"

#include <algorithm>
#include <map>

namespace stillmap {

Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame) {
  return session.map.T_world_keyframe(frame.reference) * frame.T_reference_frame;
}

SubmapId submap_of(const Session& session, const FrameRecord& frame) {
  return session.map.keyframe(session.map.anchor(frame.reference).keyframe).submap;
}

SubmapId main_submap(const Session& session, std::size_t first_frame) {
  std::map<SubmapId, std::size_t> frames;
  for (std::size_t i = first_frame; i < session.frames.size(); ++i) {
    ++frames[submap_of(session, session.frames[i])];
  }
  // The first of equal maxima in the sorted map: the lowest submap.
  const auto most = std::ranges::max_element(
      frames, {}, [](const std::pair<const SubmapId, std::size_t>& entry) { return entry.second; });
  return most == frames.end() ? SubmapId{} : most->first;
}

Trajectory trajectory_in(const Session& session, SubmapId submap, std::size_t first_frame) {
  Trajectory trajectory;
  for (std::size_t i = first_frame; i < session.frames.size(); ++i) {
    const FrameRecord& frame = session.frames[i];
    if (submap_of(session, frame) != submap) continue;
    trajectory.push_back({frame.stamp, T_world_frame(session, frame)});
  }
  return trajectory;
}

Trajectory keyframes_in(const Session& session, SubmapId submap) {
  Trajectory trajectory;
  for (const auto& [id, keyframe] : session.map.keyframes()) {
    if (keyframe.submap == submap) trajectory.push_back({keyframe.stamp, keyframe.T_world_camera});
  }
  return trajectory;
}

std::vector<PosedView> posed_views(const Session& session, SubmapId submap) {
  std::vector<PosedView> views;
  for (const ViewRecord& record : session.views) {
    const FrameRecord& frame = session.frames[record.frame];
    if (submap_of(session, frame) != submap) continue;
    views.push_back({T_world_frame(session, frame), record.view.get()});
  }
  return views;
}

}  // namespace stillmap
