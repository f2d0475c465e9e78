// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// What a run keeps of an object in a frame. Place and velocity are in the camera's axes, so that a
/// later correction of the frame's pose moves them too.
struct LoggedObject {
  ObjectState state;
  std::optional<Eigen::Vector3d> p_camera;      ///< middle of what is seen of it
  std::optional<Eigen::Vector3d> v_camera_m_s;  ///< its own velocity; none where not known
};

struct LoggedFrame {
  Stamp stamp;
  std::vector<LoggedObject> objects;  ///< in the order of the frame's objects
};

/// What is to be kept of a frame that dynamics was run on.
[[nodiscard]] LoggedFrame log_frame(const FrameResult& result);

/// The lines of objects.jsonl, one a frame, in order; each is a JSON object:
/// `{"stamp","objects":[{"track","class","category","state","reason","motion","by","person","box",
/// "filled","p_world","v_world"}]}`.
///
/// `state` is "dynamic" or "static"; `motion` "still", "moving", "moved by someone" or "unknown";
/// `by` the track of who moves it and `person` of who touches it or is before or behind it; `box`
/// as in detections; `filled`: the network has missed it. `p_world` and `v_world`, in metres and
/// metres a second, are under the poses of `final_poses`, which has the stamps of some of the
/// frames, in order. What is not known is null: so are both in a frame without a pose.
[[nodiscard]] std::string objects_jsonl(std::span<const LoggedFrame> frames,
                                        const Trajectory& final_poses);

/// What the frames say of each object on the whole, in the order of the tracks' numbers.
[[nodiscard]] std::vector<ObjectSummary> summarize_objects(std::span<const LoggedFrame> frames);

}  // namespace stillmap
