// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_map.hpp"

#include <algorithm>
#include <map>

namespace stillmap {
namespace {

constexpr double kMaxGap_s = 0.2;  // between frames that tell the motion from one to the other

// The pose at the time of the view's depth: on the way to the frame after, or before, by that time;
// along that way where the frame on this side is missing.
Eigen::Isometry3d T_world_view(const Session& session,
                               const ViewRecord& view,
                               const Eigen::Isometry3d& T_world_frame,
                               const PoseOfRecord& T_world_record) {
  if (view.depth_after_color_s == 0) return T_world_frame;
  const double stamp_s = session.frames[view.frame].stamp.seconds;
  const int side = view.depth_after_color_s > 0 ? 1 : -1;
  for (const int step : {side, -side}) {
    const std::int64_t i = static_cast<std::int64_t>(view.frame) + step;
    if (i < 0 || i >= static_cast<std::int64_t>(session.frames.size())) continue;
    const auto neighbor = static_cast<std::size_t>(i);
    const double gap_s = session.frames[neighbor].stamp.seconds - stamp_s;
    if (gap_s * step <= 0 || gap_s * step > kMaxGap_s) continue;
    const std::optional<Eigen::Isometry3d> T = T_world_record(neighbor);
    if (T) return interpolate(T_world_frame, *T, view.depth_after_color_s / gap_s);
  }
  return T_world_frame;
}

}  // namespace

Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame) {
  return session.map.T_world_keyframe(frame.reference) * frame.T_reference_frame;
}

SubmapId submap_of(const Session& session, const FrameRecord& frame) {
  return session.map.keyframe(session.map.anchor(frame.reference).keyframe).submap;
}

SubmapId main_submap(const Session& session, std::size_t first_frame) {
  std::map<SubmapId, std::size_t> frames;
  for (auto frame = session.frames.from(first_frame); frame != session.frames.end(); ++frame) {
    ++frames[submap_of(session, *frame)];
  }
  // The first of equal maxima in the sorted map: the lowest submap.
  const auto most = std::ranges::max_element(
      frames, {}, [](const std::pair<const SubmapId, std::size_t>& entry) { return entry.second; });
  return most == frames.end() ? SubmapId{} : most->first;
}

Trajectory trajectory_in(const Session& session, SubmapId submap, std::size_t first_frame) {
  Trajectory trajectory;
  for (auto at = session.frames.from(first_frame); at != session.frames.end(); ++at) {
    const FrameRecord frame = *at;
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
  return posed_views(session, [&](std::size_t i) -> std::optional<Eigen::Isometry3d> {
    const FrameRecord frame = session.frames[i];
    if (submap_of(session, frame) != submap) return std::nullopt;
    return T_world_frame(session, frame);
  });
}

std::vector<PosedView> posed_views(const Session& session, const PoseOfRecord& T_world_frame) {
  std::vector<PosedView> views;
  for (const ViewRecord& record : session.views) {
    const std::optional<Eigen::Isometry3d> T = T_world_frame(record.frame);
    if (T) views.push_back({T_world_view(session, record, *T, T_world_frame), record.view.get()});
  }
  return views;
}

}  // namespace stillmap
