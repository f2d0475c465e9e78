// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/interruptible_stream.hpp"
#include "apps/run_arguments.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/sensor/sequence_content.hpp"
#include "tooling/devices/device.hpp"
#include "tooling/devices/recording_stream.hpp"
#include "tooling/pipeline/map_evaluation.hpp"

namespace stillmap {

/// What a run reads: a recording or a device, and what is known of it.
class RunInput {
 public:
  /// Opens what the command line names; nothing has been read of its frames. `clock` outlives the
  /// object. Throws Error as opening does, and for options that do not fit together.
  RunInput(const RunArguments& arguments, Clock& clock);

  /// The frames, which end when the run is interrupted. They are kept where that is asked for.
  [[nodiscard]] FrameStream& frames();

  /// Of the sequence or the device, for reports.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// How it was understood, in one line.
  [[nodiscard]] const std::string& line() const { return line_; }
  /// The images of a recording; none of a device.
  [[nodiscard]] const std::vector<SequenceEntry>& entries() const { return entries_; }
  /// The noise of depth made from stereo pairs.
  [[nodiscard]] const std::optional<DepthNoise>& depth_noise() const { return depth_noise_; }
  [[nodiscard]] bool is_device() const { return device_ != nullptr; }
  [[nodiscard]] const std::optional<Trajectory>& true_poses() const { return true_poses_; }
  /// Of a rendered sequence.
  [[nodiscard]] const std::optional<SequenceTruth>& truth() const { return truth_; }
  /// What was wrong with it, before any frame.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// One line that says where a recording ended early; empty where it did not. A device's frames
  /// have no other end than an interruption.
  [[nodiscard]] std::string interruption() const;

  /// Writes the recording, if one is kept; returns what is said of it. To be called once, after the
  /// last frame.
  [[nodiscard]] std::string finish_recording();

 private:
  void open_sequence_input(const RunArguments& arguments);
  void open_device_input(const RunArguments& arguments, Clock& clock);

  std::string name_, line_, saved_in_;
  std::vector<SequenceEntry> entries_;
  std::optional<DepthNoise> depth_noise_;
  std::optional<Trajectory> true_poses_;
  std::optional<SequenceTruth> truth_;
  std::vector<std::string> warnings_;
  std::unique_ptr<Device> device_;  // null: a recording
  std::unique_ptr<FrameStream> source_;
  std::unique_ptr<InterruptibleStream> interruptible_;  // of a recording
  std::unique_ptr<RecordingStream> kept_;
};

}  // namespace stillmap
