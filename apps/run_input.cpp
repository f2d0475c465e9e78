// SPDX-License-Identifier: Apache-2.0
#include "apps/run_input.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "apps/interruption.hpp"
#include "apps/option_value.hpp"
#include "apps/progress_bar.hpp"
#include "apps/sensor_camera.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tooling/devices/device_stream.hpp"
#include "tooling/devices/open_device.hpp"

namespace stillmap {
namespace {

void check_arguments(const RunArguments& arguments) {
  if (arguments.sequence.path.empty() == arguments.device.empty()) {
    throw Error("name a SEQUENCE, or a camera with --device{}",
                arguments.device.empty() ? "" : "; not both");
  }
  const bool names_topics =
      !arguments.sequence.color_topic.empty() || !arguments.sequence.depth_topic.empty();
  if (names_topics && !arguments.device.empty() && !arguments.device.starts_with("stream:")) {
    throw Error("--device {}: has no topics; --color-topic and --depth-topic are for stream:URL",
                arguments.device);
  }
  if (arguments.save_recording.empty()) return;
  if (!arguments.live && arguments.device.empty()) {
    throw Error("--save-recording keeps the frames of a live run: add --live, or name a --device");
  }
  std::error_code ignored;
  if (std::filesystem::weakly_canonical(arguments.save_recording, ignored) ==
      std::filesystem::weakly_canonical(arguments.out, ignored)) {
    throw Error("--save-recording {}: is the folder of --out; name another",
                arguments.save_recording);
  }
}

// The true poses that the options name, or the recording's own; none where they cannot be used.
GroundTruth chosen_groundtruth(const RunArguments& arguments, const Sequence& sequence) {
  if (arguments.groundtruth == "none") return {};
  if (arguments.groundtruth.empty()) return sequence.groundtruth().value_or(GroundTruth{});
  if (!path_exists(arguments.groundtruth)) {
    throw Error("--groundtruth {}: no such file", arguments.groundtruth);
  }
  return read_groundtruth(arguments.groundtruth, sequence_options(arguments.sequence).reading);
}

FrameSelection selected_frames(const RunArguments& arguments) {
  FrameSelection selection;
  if (!arguments.frames.empty()) {
    selection = option_value("--frames", arguments.frames, parse_frames);
  }
  selection.stride = arguments.stride;
  return selection;
}

double time_of_day_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

RunInput::RunInput(const RunArguments& arguments, Clock& clock) {
  check_arguments(arguments);
  if (arguments.device.empty()) {
    open_sequence_input(arguments);
  } else {
    open_device_input(arguments, clock);
  }
  saved_in_ = arguments.save_recording;
  if (saved_in_.empty()) return;
  kept_ = option_value("--save-recording", saved_in_, [this](const std::string& folder) {
    FrameStream& frames = interruptible_ ? *interruptible_ : *source_;
    return std::make_unique<RecordingStream>(frames, folder);
  });
}

void RunInput::open_sequence_input(const RunArguments& arguments) {
  Sequence sequence = open_sequence(arguments.sequence);
  const FrameSelection selection = selected_frames(arguments);
  warnings_ = sequence.remarks().warnings;
  const SensorCamera sensor = sensor_camera(sequence, selection, arguments.depth_factor);
  sequence.use_camera(sensor.camera);
  if (!sensor.depth_unit.empty()) warnings_.push_back(sensor.depth_unit);
  GroundTruth groundtruth = chosen_groundtruth(arguments, sequence);
  std::ranges::move(groundtruth.warnings, std::back_inserter(warnings_));
  if (!groundtruth.poses.empty()) true_poses_ = std::move(groundtruth.poses);
  if (arguments.poses == "truth" && !true_poses_) {
    throw Error("--poses truth: {} has no ground truth; name one with --groundtruth",
                sequence.path().string());
  }
  truth_ = read_sequence_truth(arguments.sequence.path);
  name_ = sequence.name();
  line_ = input_line(sequence);
  entries_ = sequence.entries();
  depth_noise_ = sequence.depth_noise();
  source_ = std::make_unique<SequenceStream>(std::move(sequence), selection);
  interruptible_ = std::make_unique<InterruptibleStream>(*source_);
}

void RunInput::open_device_input(const RunArguments& arguments, Clock& clock) {
  DeviceRequest request;
  request.color_topic = arguments.sequence.color_topic;
  request.depth_topic = arguments.sequence.depth_topic;
  const std::string& camera = arguments.sequence.camera;
  if (!camera.empty()) request.camera = camera_by_name(camera);
  device_ = option_value("--device", arguments.device, [&](const std::string& text) {
    return open_device(text, request);
  });
  DeviceStreamOptions options;
  options.camera = request.camera;
  warnings_ = device_->warnings();
  options.begin_s = time_of_day_s();
  options.stopped = interruption_noted;
  options.tell = [](const std::string& line) { ProgressBar("frames").warn(line); };
  name_ = arguments.device;
  source_ = std::make_unique<DeviceStream>(*device_, clock, std::move(options));
  const CameraModel& model = source_->camera();
  line_ = fmt::format("{}, {}x{}", name_, model.width_px, model.height_px);
  if (!device_->choice().empty()) line_ += "; " + device_->choice();
}

FrameStream& RunInput::frames() {
  if (kept_) return *kept_;
  return interruptible_ ? *interruptible_ : *source_;
}

std::string RunInput::interruption() const {
  return interruptible_ ? interruptible_->interruption() : "";
}

std::string RunInput::finish_recording() {
  if (!kept_) return {};
  kept_->finish();
  return fmt::format("recording   {} frames in {}\n", kept_->frames(), saved_in_);
}

}  // namespace stillmap
