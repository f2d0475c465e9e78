// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// Pose of a frame in its world, as the key frames are now.
[[nodiscard]] Eigen::Isometry3d T_world_frame(const Session& session, const FrameRecord& frame);

/// The world of a frame: that of its key frame, or of what a dropped one is fixed to.
[[nodiscard]] WorldId world_of(const Session& session, const FrameRecord& frame);

/// The world with most of the frames from `first_frame` on, the lowest of equals; invalid when
/// there are no such frames.
[[nodiscard]] WorldId main_world(const Session& session, std::size_t first_frame = 0);

/// Poses of the frames from `first_frame` on that are in a world, in the order in which they were
/// tracked. Their stamps increase within what one run has added.
[[nodiscard]] Trajectory trajectory_in(const Session& session,
                                       WorldId world,
                                       std::size_t first_frame = 0);

/// Poses of the key frames of a world, by id.
[[nodiscard]] Trajectory keyframes_in(const Session& session, WorldId world);

}  // namespace stillmap
