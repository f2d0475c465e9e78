// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {

/// min(count, limit) indexes below `count`, evenly spread, ascending.
[[nodiscard]] std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t limit);

/// The positions of the poses, cut at gaps of more than half a second.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> continuous_parts(const Trajectory& poses);

inline constexpr std::size_t kMapViewPoints = 150'000;

/// The data of map_view.js as JSON without '<': in level axes, `positions` 16 bit little endian
/// (value = low + code * step), `colors` 8 bit, both base64; `paths` of the cameras and `frusta` of
/// at most 300 key frames as coordinates in metres; the initial `view`; `head_y`, above which the
/// ceiling is. At most `limit` points of the map, evenly spread.
[[nodiscard]] std::string map_view_json(const PointCloud& map,
                                        const SceneFrame& scene,
                                        const Trajectory& cameras,
                                        const Trajectory& keyframes,
                                        std::size_t limit = kMapViewPoints);

}  // namespace stillmap
