// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// The pose of a frame in its submap under the present key frame poses.
[[nodiscard]] Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame);

/// The submap of a frame: that of its key frame, or of the anchor of a removed key frame.
[[nodiscard]] SubmapId submap_of(const Session& session, const FrameRecord& frame);

/// The submap with most of the frames from `first_frame` on; the lowest among equals. Invalid
/// without such frames.
[[nodiscard]] SubmapId main_submap(const Session& session, std::size_t first_frame = 0);

/// The poses of the frames from `first_frame` on in a submap, in the order of tracking. Stamps
/// increase within the frames of one run.
[[nodiscard]] Trajectory trajectory_in(const Session& session,
                                       SubmapId submap,
                                       std::size_t first_frame = 0);

/// The poses of the key frames of a submap, by id.
[[nodiscard]] Trajectory keyframes_in(const Session& session, SubmapId submap);

/// The views of a submap, each with the pose of the camera when its depth was taken, in the order
/// of the frames. They refer to the session and must not outlive it.
[[nodiscard]] std::vector<PosedView> posed_views(const Session& session, SubmapId submap);

/// The pose of a frame by the index of its record; nothing where it is to be left out.
using PoseOfRecord = std::function<std::optional<Eigen::Isometry3d>(std::size_t)>;

/// The same for the views of frames that have a pose.
[[nodiscard]] std::vector<PosedView> posed_views(const Session& session,
                                                 const PoseOfRecord& T_world_frame);

}  // namespace stillmap
