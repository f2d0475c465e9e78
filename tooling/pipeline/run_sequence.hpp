// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/pipeline/live_record.hpp"
#include "tooling/pipeline/run_observer.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// A run as with a camera: no frame waits for later ones, or for the network.
struct LiveOptions {
  double speed = 1;                        ///< of the clock that frames come by
  std::optional<LiveRecord> record;        ///< instead of by the clock: what was decided then
  std::string record_name = "the record";  ///< its file, for messages
  Clock* clock = nullptr;                  ///< not owned; needed without a record
};

struct RunOptions {
  int threads = 2;
  std::optional<LiveOptions> live;       ///< instead of as fast as it goes, with no frame left out
  std::optional<Session> start;          ///< a saved session that the run goes on from
  bool localize_only = false;            ///< the map stays as `start` has it
  const Segmenter* segmenter = nullptr;  ///< what finds objects; none where null
  /// Observers are given the dense map so far whenever that many frames have been processed; 0: at
  /// the end alone.
  std::int64_t snapshot_every_frames = 0;
  /// Where there is one, the map is made once more with its poses.
  std::optional<Trajectory> groundtruth;
  StageProbe probe = {};  ///< of tests
};

struct SequenceRun {
  RunResult result;
  Session session;  ///< what can be saved; its settings are the caller's
  /// All that the run itself knows; `map` is not set. What concerns ground truth, configuration and
  /// version is the caller's.
  RunReport report;
  /// The map with the frames where ground truth has them, in the world of the run; frames without a
  /// true pose add nothing to it. Nothing without ground truth, or with too little to align.
  std::optional<PointCloud> map_at_true_poses;
  LiveRecord live_record;  ///< of a live run: what the clock has decided
  /// What objects.jsonl says; nullopt when nothing looked for objects or nothing is done about
  /// them.
  std::optional<std::string> objects_jsonl;
};

/// Runs the system over a sequence. A damaged image inside a long sequence costs its frame, with a
/// warning; more than one frame in fifty, or any in a sequence below fifty frames, is an Error, and
/// so is an image of the wrong kind or size. The result does not depend on the number of threads;
/// that of a live run depends on the clock, by what its record says and nothing else. `observers`
/// outlive the run; see RunObserver for what they may hear besides.
[[nodiscard]] SequenceRun run_sequence(FrameStream& stream,
                                       const SystemConfig& config,
                                       RunOptions options,
                                       std::span<Observer* const> observers = {});

}  // namespace stillmap
