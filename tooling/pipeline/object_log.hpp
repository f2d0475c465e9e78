// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/objects/object_state.hpp"
#include "stillmap/system/observer.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The objects of a frame, and the pose that it had when it was processed. Positions and velocities
/// of the objects are under that pose, so that a later correction of the pose moves them, too.
using LoggedFrame = std::pair<StampedPose, std::vector<ObjectState>>;
[[nodiscard]] inline LoggedFrame log_frame(const FrameResult& result) {
  return {{result.stamp, result.T_world_camera}, result.objects};
}

/// The lines of objects.jsonl, one a frame, in order; each is a JSON object:
/// `{"stamp","objects":[{"track","class","category","state","reason","motion","by","person","box",
/// "filled","p_world","v_world"}]}`.
///
/// `state` is "dynamic" or "static"; `motion` "still", "moving", "moved by someone" or "unknown";
/// `by` is the track of the person who moves it, `person` that of the person who touches it or is
/// before or behind it; `box` as in detections; `filled`: the network has missed it. `p_world` and
/// `v_world`, in metres and metres a second, are under the poses of `final_poses`, which has the
/// stamps of some of the frames, in order. Unknown values are null; without a final pose both are.
[[nodiscard]] std::string objects_jsonl(std::span<const LoggedFrame> frames,
                                        const Trajectory& final_poses);

/// A summary of each object over all frames, by ascending track number.
[[nodiscard]] std::vector<ObjectSummary> summarize_objects(std::span<const LoggedFrame> frames);

/// Keeps the objects of all frames judged by the dynamics stage. Parts of an object that the
/// network sees apart share its track.
class ObjectLog : public Observer {
 public:
  void on_frame(const RgbdFrame& /*frame*/, const FrameResult& result) override {
    frames_.push_back(log_frame(result));
  }
  /// Gives the objects the tracks that they are known by at the end.
  void on_end(const RunResult& result) override;

  /// See objects_jsonl().
  [[nodiscard]] std::string jsonl(const Trajectory& final_poses) const {
    return objects_jsonl(frames_, final_poses);
  }
  [[nodiscard]] std::vector<ObjectSummary> summaries() const { return summarize_objects(frames_); }

 private:
  std::vector<LoggedFrame> frames_;
};

}  // namespace stillmap
