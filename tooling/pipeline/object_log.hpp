// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/io/scratch_records.hpp"
#include "stillmap/perception/objects/object_state.hpp"
#include "stillmap/system/observer.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/pipeline/lasting_tracks.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The objects of a frame, and the pose that it had when it was processed. Positions and velocities
/// of the objects are under that pose, so that a later correction of the pose moves them, too.
using LoggedFrame = std::pair<StampedPose, std::vector<ObjectState>>;

/// Keeps the objects of all frames judged by the dynamics stage, on the disk. Parts of an object
/// that the network sees apart share its track.
class ObjectLog : public Observer {
 public:
  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  /// Gives the objects the tracks that they are known by at the end.
  void on_end(const RunResult& result) override { lasting_ = LastingTracks(result.united_tracks); }

  /// The lines of objects.jsonl, one a frame, in order; each is a JSON object:
  /// `{"stamp","objects":[{"track","class","category","state","reason","motion","by","person",
  /// "box","filled","p_world","v_world"}]}`.
  ///
  /// `state` is "dynamic" or "static"; `motion` "still", "moving", "moved by someone" or "unknown";
  /// `by` is the track of the person who moves it, `person` that of the person who touches it or is
  /// before or behind it; `box` as in detections; `filled`: the network has missed it. `p_world`
  /// and `v_world`, in metres and metres a second, are under the poses of `final_poses`, which has
  /// the stamps of some of the frames, in order. Unknown values are null; without a final pose both
  /// are.
  [[nodiscard]] std::string jsonl(const Trajectory& final_poses) const;
  /// A summary of each object over all frames, by ascending track number.
  [[nodiscard]] std::vector<ObjectSummary> summaries() const;

 private:
  void visit(const std::function<void(const LoggedFrame& frame)>& visit) const;

  ScratchRecords frames_;
  LastingTracks lasting_{{}};
};

}  // namespace stillmap
