// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// Pose of a frame in its submap, as the key frames are now.
[[nodiscard]] Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame);

/// The submap of a frame: that of its key frame, or of what a dropped one is fixed to.
[[nodiscard]] SubmapId submap_of(const Session& session, const FrameRecord& frame);

/// The submap with most of the frames from `first_frame` on, the lowest of equals; invalid when
/// there are no such frames.
[[nodiscard]] SubmapId main_submap(const Session& session, std::size_t first_frame = 0);

/// Poses of the frames from `first_frame` on that are in a submap, in the order in which they were
/// tracked. Their stamps increase within what one run has added.
[[nodiscard]] Trajectory trajectory_in(const Session& session,
                                       SubmapId submap,
                                       std::size_t first_frame = 0);

/// Poses of the key frames of a submap, by id.
[[nodiscard]] Trajectory keyframes_in(const Session& session, SubmapId submap);

/// The views of a submap at their frames' poses, in the order of the frames. They refer to the
/// session.
[[nodiscard]] std::vector<PosedView> posed_views(const Session& session, SubmapId submap);

}  // namespace stillmap
