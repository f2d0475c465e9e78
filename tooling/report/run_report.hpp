// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/browser/ghost_points.hpp"
#include "tooling/browser/viewed_frame.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/rpe.hpp"

namespace stillmap {

/// The times of one stage, milliseconds, one for each time that it ran.
struct StageTimes {
  std::string name;
  std::vector<double> ms;
};

/// A frame shown in the report, with its result. Of the images only colour is needed.
using ReportSample = std::pair<RgbdFrame, FrameResult>;

/// A summary of one track over all its frames.
struct ObjectSummary {
  struct MotionCount {
    std::string motion;
    std::size_t frames = 0;
  };
  std::uint32_t track = 0;  ///< its number
  std::string class_name;
  std::string category;
  std::size_t frames = 0;            ///< in which it is
  std::size_t filled = 0;            ///< of these, in which the network has missed it
  std::size_t dynamic = 0;           ///< of these, in which it counted as dynamic
  std::string main_reason;           ///< the most frequent reason of its state
  std::vector<MotionCount> motions;  ///< number of frames of each motion
};

/// Figures of a live run.
struct LiveReport {
  std::optional<double> speed;             ///< of the camera's clock; none for a replayed run
  std::size_t dropped = 0;                 ///< frames that came while others were being processed
  std::size_t looked_at = 0;               ///< frames that the network has processed
  std::vector<double> objects_age_frames;  ///< of each frame with objects
  std::vector<double> latency_ms;          ///< from a frame's arrival to its pose
};

/// All data of a run's reports. A plain value, filled by the code that runs the system. Unknown
/// values stay empty: `nullopt`, or no elements.
struct RunReport {
  std::string version;       ///< of the program
  std::string sequence;      ///< name or path of the sequence; any text
  CameraModel camera;        ///< as used
  double depth_delay_s = 0;  ///< of depth images against their stamps, as learnt
  std::string config_yaml;   ///< the effective configuration

  std::size_t frames_total = 0;       ///< associated rgb-depth pairs of the run
  std::size_t frames_tracked = 0;     ///< poses in the trajectory
  std::vector<DamagedFrame> skipped;  ///< unreadable ones, in order
  std::vector<Stamp> lost;            ///< frames read but without a pose, in order

  std::size_t frames_elsewhere = 0;  ///< tracked in a submap not joined to the main one
  std::vector<ClosedLoop> loops;     ///< closed in this run, in order

  Trajectory estimate;   ///< final poses of all tracked frames, in the run's world frame
  Trajectory keyframes;  ///< the same of the key frames
  std::optional<Trajectory> groundtruth;  ///< in its own world frame
  std::optional<AteResult> ate;
  std::optional<RpeResult> rpe;

  std::optional<double> wall_s;       ///< of the whole run
  std::vector<double> frame_ms;       ///< a frame's arrival to its pose, network excluded, in order
  std::vector<StageTimes> stages;     ///< in the order in which they run
  std::vector<int> tracked_features;  ///< of each frame, in order
  std::optional<double> peak_memory_mb;
  std::optional<LiveReport> live;  ///< of a live run

  std::string dynamics_mode;  ///< name of the mode
  /// Number of frames with features in boxes of dynamic objects, by what the matches of these were
  /// judged by; empty if the mode judges no matches.
  std::map<std::string, std::size_t> matches_judged_by;
  /// By ascending track number; nullopt without a source of objects.
  std::optional<std::vector<ObjectSummary>> objects;
  /// Things that have left their place for another, nobody having looked at the old one again.
  std::vector<VacatedPlace> vacated;
  /// From the first frame to the first with an object of a dynamic class; nullopt if none.
  std::optional<double> first_dynamic_s;

  std::vector<ReportSample> samples;  ///< about eight, in order
  std::vector<ViewedFrame> viewed;    ///< frames as the map's view shows them, in order
  std::vector<StampedGhosts> movers;  ///< what moved in frames, if it was kept; in order
  const PointCloud* map = nullptr;  ///< not owned, outlives the report; nullptr when none was made
  bool map_at_true_poses = false;   ///< made with the poses of ground truth, not the estimate's
  std::optional<MapQuality> map_quality;             ///< of `map`
  std::optional<MapQuality> map_quality_true_poses;  ///< of the map made with true poses
  std::vector<std::string> warnings;
};

}  // namespace stillmap
