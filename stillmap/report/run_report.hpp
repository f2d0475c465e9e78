// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/camera.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/eval/ate.hpp"
#include "stillmap/eval/rpe.hpp"

namespace stillmap {

/// A frame that could not be read, and why.
struct SkippedFrame {
  Stamp stamp;
  std::string message;
};

/// The times of one stage of the work, milliseconds, one for each time that it ran.
struct StageTimes {
  std::string name;
  std::vector<double> ms;
};

/// A frame shown in the report, with its features at raw pixels.
struct SampleFrame {
  Stamp stamp;
  ColorImage image;
  std::vector<Eigen::Vector2f> tracked_px;    ///< matched to the map
  std::vector<Eigen::Vector2f> untracked_px;  ///< found, but not matched
};

/// All that the reports of a run say. A plain value: whoever ran the run fills it. What is not
/// known stays empty: `nullopt`, or no elements.
struct RunReport {
  std::string version;      ///< of the program
  std::string sequence;     ///< name or path of the sequence; any text
  CameraModel camera;       ///< as used
  std::string config_yaml;  ///< the effective configuration

  std::size_t frames_total = 0;       ///< associated rgb-depth pairs that were asked for
  std::size_t frames_tracked = 0;     ///< poses in the trajectory
  std::vector<SkippedFrame> skipped;  ///< unreadable ones, in order
  std::vector<Stamp> lost;            ///< frames read but without a pose, in order

  Trajectory estimate;                    ///< final poses of all tracked frames, in the run's world
  Trajectory keyframes;                   ///< the same of the key frames
  std::optional<Trajectory> groundtruth;  ///< in its own world
  std::optional<AteResult> ate;
  std::optional<RpeResult> rpe;

  std::optional<double> wall_s;       ///< of the whole run
  std::vector<double> frame_ms;       ///< a frame's arrival to its pose, network excluded, in order
  std::vector<StageTimes> stages;     ///< in the order in which they run
  std::vector<int> tracked_features;  ///< of each frame, in order
  std::optional<double> peak_memory_mb;

  std::vector<SampleFrame> samples;  ///< about eight, in order
  const PointCloud* map = nullptr;   ///< not owned, outlives the report; nullptr when none was made
  std::vector<std::string> warnings;
};

}  // namespace stillmap
