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
  bool arriving = false;  ///< the stream waits for its frames itself, as that of a device does
  double speed = 1;       ///< of the clock by which the frames of another stream come
  std::optional<LiveRecord> record;        ///< its decisions replace those of the clock
  std::string record_name = "the record";  ///< its file, for messages
  Clock* clock = nullptr;                  ///< not owned; needed without a record
};

struct RunOptions {
  int threads = 2;
  std::optional<LiveOptions> live;       ///< nullopt: as fast as possible, without dropping frames
  std::optional<Session> start;          ///< a saved session that the run continues
  bool localize_only = false;            ///< the map stays as `start` has it
  const Segmenter* segmenter = nullptr;  ///< null: no objects
  /// Observers are given the dense map so far each time this number of frames has been processed;
  /// 0: only at the end.
  std::int64_t snapshot_every_frames = 0;
  /// If set, the map is also made with its poses.
  std::optional<Trajectory> groundtruth;
  StageProbe probe = {};  ///< for tests
};

struct SequenceRun {
  RunResult result;
  Session session;  ///< to be saved; the caller fills in its settings
  /// All that the run itself knows; `map` is not set. The caller fills in ground truth,
  /// configuration and version.
  RunReport report;
  /// The map with the frames at their true poses, in the run's world frame; frames without a true
  /// pose add nothing to it. Nothing without ground truth, or with too little to align.
  std::optional<PointCloud> map_at_true_poses;
  LiveRecord live_record;  ///< of a live run: the decisions of the clock
  /// The text of objects.jsonl; nullopt without a source of objects or where the mode ignores them.
  std::optional<std::string> objects_jsonl;
};

/// Runs the system over a sequence. A damaged image inside a long sequence costs its frame, with a
/// warning; more than one damaged frame in fifty, or any in a sequence below fifty frames, is an
/// Error, and so is an image of the wrong kind or size. The result does not depend on the number of
/// threads; that of a live run depends on the clock only through the decisions in its record.
/// `observers` outlive the run; those that are RunObservers get more calls.
[[nodiscard]] SequenceRun run_sequence(FrameStream& stream,
                                       const SystemConfig& config,
                                       RunOptions options,
                                       std::span<Observer* const> observers = {});

}  // namespace stillmap
