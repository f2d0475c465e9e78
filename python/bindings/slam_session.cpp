// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/slam_session.hpp"

#include <utility>

#include "python/bindings/arrays.hpp"
#include "python/bindings/objects.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/stopwatch.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

void check_size(const cv::Mat& image, const char* name, const CameraModel& camera) {
  if (image.cols == camera.width_px && image.rows == camera.height_px) return;
  throw Error("{}: {} x {} pixels, expected {} x {} as the camera has (height x width)",
              name,
              image.rows,
              image.cols,
              camera.height_px,
              camera.width_px);
}

std::optional<FrameDetections> detections_of(const py::object& objects, cv::Size image) {
  if (objects.is_none()) return std::nullopt;
  if (!py::isinstance<FrameDetections>(objects)) {
    throw Error("objects: {}, expected Detections or None", description_of(objects));
  }
  return checked_detections(py::cast<FrameDetections>(objects), image);
}

}  // namespace

Slam::Slam(const CameraModel& camera, const Settings& settings, const SlamOptions& options)
    : camera_(camera),
      settings_(settings),
      localize_only_(options.localize_only),
      tracker_(settings.config().dynamics.object_tracking(), FillRule::kCausal) {
  if (options.threads < 1) throw Error("threads: {}, expected 1 or more", options.threads);
  if (localize_only_ && !options.load) {
    throw Error("localize_only needs a map to find the camera in: name a map.stillmap with load");
  }
  const py::gil_scoped_release release;
  system_ = std::make_unique<System>(
      settings_,
      camera_,
      SystemOptions{.threads = options.threads, .localize_only = localize_only_});
  if (options.load) system_->load(read_session(*options.load));
}

// The workers must not wait for this thread's GIL, nor it for them.
Slam::~Slam() {
  const py::gil_scoped_release release;
  system_.reset();
  tracker_ = ObjectTracker({}, FillRule::kCausal);
}

System& Slam::running() const {
  if (system_ == nullptr) throw Error("the run has ended with finish(); make a new Slam");
  return *system_;
}

Slam::Input Slam::input_of(const FrameArguments& arguments) {
  lent_.give_up_unused();
  ColorImage color = color_image(arguments.color, lent_);
  DepthImage depth = depth_image(arguments.depth, camera_.depth_factor, lent_);
  check_size(color.mat, "color", camera_);
  check_size(depth.mat, "depth", camera_);
  if (arguments.copy) {
    color.mat = color.mat.clone();
    depth.mat = depth.mat.clone();
  }
  Stamp stamp = stamp_of(arguments.stamp);
  std::optional<FrameDetections> detections = detections_of(arguments.objects, color.mat.size());
  auto frame = std::make_shared<RgbdFrame>();
  frame->depth_stamp_s = stamp.seconds;
  frame->stamp = std::move(stamp);
  frame->color = std::move(color);
  frame->depth = std::move(depth);
  return {std::move(frame), std::move(detections)};
}

FrameResult Slam::process(Input input) {
  System& system = running();
  const auto frame = std::make_shared<RgbdFrame>(*input.frame);
  if (last_stamp_ && !(frame->stamp.seconds > last_stamp_->seconds)) {
    throw Error(
        "stamp: {} after {}, expected stamps that increase", frame->stamp.text, last_stamp_->text);
  }
  last_stamp_ = frame->stamp;
  frame->id = FrameId(frames_++);
  frame->gray = to_gray(frame->color);
  if (input.detections) {
    has_network_ = true;
    input.detections->stamp = frame->stamp;
    std::optional<FrameObjects> objects =
        tracker_.push({frame->id, *std::move(input.detections), frame->depth});
    STILLMAP_CHECK(objects.has_value());  // a causal tracker gives each frame at once
    return system.process(frame, *std::move(objects));
  }
  if (!has_network_) return system.process(frame, FrameObjects{frame->id, frame->stamp, {}, {}});
  return system.process(
      frame, tracker_.carry_to(frame->id, frame->stamp, frame->depth), MaskOrigin::kCarried);
}

ProcessedFrame Slam::process(const FrameArguments& arguments) {
  Input input = input_of(arguments);
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  Stopwatch watch;
  ProcessedFrame processed;
  processed.result = process(std::move(input));
  processed.library_ms = watch.lap_ms();
  return processed;
}

bool Slam::needs_objects() {
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  return system_ != nullptr && system_->needs_own_objects();
}

PointCloud Slam::map() {
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  return system_ == nullptr ? result_->map : system_->map_snapshot();
}

std::shared_ptr<const RunResult> Slam::finish() {
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  if (system_ != nullptr) {
    result_ = std::make_shared<const RunResult>(system_->finish());
    camera_.readout_s = system_->readout_s();
    session_ = system_->take_session();
    session_.config_yaml = settings_.yaml();
    system_.reset();
  }
  return result_;
}

void Slam::save(const std::filesystem::path& file) {
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  if (system_ != nullptr) throw Error("{}: finish() comes before save()", file.string());
  if (localize_only_) {
    throw Error("{}: not written; a run that only localises leaves its map as it was",
                file.string());
  }
  write_session(file, session_);
}

CameraModel Slam::camera() {
  const py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  CameraModel camera = camera_;
  if (system_ != nullptr) camera.readout_s = system_->readout_s();
  return camera;
}

}  // namespace stillmap::python
