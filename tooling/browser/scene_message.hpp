// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "tooling/browser/message.hpp"
#include "tooling/browser/point_chunks.hpp"
#include "tooling/browser/viewed_frame.hpp"

namespace stillmap {

// The parts of messages that pages draw in three dimensions, as docs/view.md describes them.

/// What a page is told first.
struct ViewStart {
  std::string title;                  ///< any text
  std::optional<std::size_t> frames;  ///< how many there will be, if known
  std::optional<CameraModel> camera;  ///< none: no frustum, no pictures
  std::optional<double> step_s = {};  ///< between frames that tell their objects, if not all do
};
[[nodiscard]] std::string start_json(const ViewStart& start);

/// How a map lies. Level axes: x right, y down to the floor, z horizontal.
struct SceneLayout {
  Eigen::Matrix3d R_level_world = Eigen::Matrix3d::Identity();
  Eigen::AlignedBox3d box;  ///< of map and cameras, in level axes; may be empty
  double head_y = 0;        ///< level y over which the ceiling is
  double spacing_m = 0.02;  ///< typical distance of neighbouring points
};

/// The small things that are sent as a whole.
struct SceneState {
  std::size_t dropped = 0, left_out = 0;
  bool finished = false;
  SceneLayout layout = {};
  Trajectory keyframes = {};  ///< of a finished run
};
/// Of the key frames at most `most_keyframes`, evenly spread.
[[nodiscard]] std::string state_json(const SceneState& state, std::size_t most_keyframes);

/// A list of the frames from `begin` to before `end`; `Frames` is a container with [].
template <class Frames>
[[nodiscard]] std::string frames_json(const Frames& frames, std::size_t begin, std::size_t end) {
  std::string list = "[";
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin) list += ',';
    list += frame_json(frames[i]);
  }
  return list + ']';
}

/// Adds at most `most` of the points that a page lacks, which has `sent` of each chunk. Returns
/// whether it lacks more.
bool add_points(Message& message,
                const PointChunks& map,
                std::vector<std::size_t>& sent,
                std::size_t most);

/// min(count, limit) indexes below `count`, evenly spread, ascending.
[[nodiscard]] std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t limit);

}  // namespace stillmap
