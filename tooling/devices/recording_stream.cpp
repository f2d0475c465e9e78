// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/recording_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/stamps.hpp"

namespace stillmap {
namespace {

bool is_file_of_recording(const std::filesystem::path& name) {
  static constexpr std::array<std::string_view, 6> kNames = {
      "rgb", "depth", "rgb.txt", "depth.txt", "associations.txt", "camera.yaml"};
  return std::ranges::find(kNames, name.begin()->string()) != kNames.end();
}

const std::filesystem::path& checked_vacant(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
    throw Error("{}: is a file, expected a folder for the recording; name another",
                folder.string());
  }
  if (!is_vacant(folder)) {
    throw Error("{}: is not empty; name a new folder for the recording", folder.string());
  }
  return folder;
}

CameraModel without_depth_camera(CameraModel camera) {
  camera.depth_camera = nullptr;
  camera.depth_factor_given = true;
  return camera;
}

// The time as its text tells it.
Stamp kept_stamp(const Stamp& stamp) {
  const std::optional<Stamp> read = parse_stamp(stamp.text);
  if (read && read->seconds == stamp.seconds) return *read;
  return parse_stamp(stamp_of_seconds(stamp.seconds).text).value();
}

// As read_depth() reads what encode_depth_png() writes.
DepthImage kept_depth(const DepthImage& depth, double depth_factor) {
  constexpr double kSaturated = 65535;
  const float factor = static_cast<float>(depth_factor);
  cv::Mat1f kept(depth.mat.size());
  for (int v = 0; v < kept.rows; ++v) {
    for (int u = 0; u < kept.cols; ++u) {
      const double units = std::round(static_cast<double>(depth.mat(v, u)) * depth_factor);
      const bool fits = units >= 0 && units < kSaturated;  // false for NaN
      kept(v, u) = fits ? static_cast<float>(units) / factor : 0.0F;
    }
  }
  return DepthImage(kept);
}

std::filesystem::path image_name(const char* kind, const Stamp& stamp) {
  return std::filesystem::path(kind) / (stamp.text + ".png");
}

}  // namespace

RecordingStream::RecordingStream(FrameStream& stream, const std::filesystem::path& folder)
    : stream_(stream),
      camera_(without_depth_camera(stream.camera())),
      files_(checked_vacant(folder), is_file_of_recording),
      writer_([this] { write_frames(); }) {}

RecordingStream::~RecordingStream() {
  waiting_.cancel();
  waiting_.close();
}

void RecordingStream::write_frames() {
  try {
    while (const std::optional<FramePtr> frame = waiting_.pop()) {
      const Stamp& stamp = (*frame)->stamp;
      files_.write(image_name("rgb", stamp), encode_png((*frame)->color));
      files_.write(image_name("depth", stamp),
                   encode_depth_png((*frame)->depth, camera_.depth_factor));
    }
  } catch (...) {  // thrown again by next() or finish()
    failure_ = std::current_exception();
    waiting_.cancel();
  }
}

FramePtr RecordingStream::as_kept(const RgbdFrame& frame) {
  RgbdFrame kept = frame;
  kept.id = FrameId(next_id_++);
  kept.stamp = kept_stamp(frame.stamp);
  const Stamp depth_stamp = parse_stamp(fmt::format("{:.9f}", frame.depth_stamp_s)).value();
  kept.depth_stamp_s = depth_stamp.seconds;
  kept.depth = kept_depth(frame.depth, camera_.depth_factor);
  const std::string rgb = fmt::format("{0} rgb/{0}.png", kept.stamp.text);
  const std::string depth = fmt::format("{} depth/{}.png", depth_stamp.text, kept.stamp.text);
  rgb_list_ += rgb + "\n";
  depth_list_ += depth + "\n";
  pairs_ += rgb + " " + depth + "\n";
  return std::make_shared<const RgbdFrame>(std::move(kept));
}

std::optional<StreamedFrame> RecordingStream::next() {
  while (std::optional<StreamedFrame> streamed = stream_.next()) {
    const FramePtr* const frame = std::get_if<FramePtr>(&*streamed);
    if (frame == nullptr) {
      ++damaged_;
      continue;
    }
    FramePtr kept = as_kept(**frame);
    if (!waiting_.push(kept)) {
      writer_.join();
      std::rethrow_exception(failure_);
    }
    return kept;
  }
  return std::nullopt;
}

std::vector<std::string> RecordingStream::warnings() const {
  std::vector<std::string> lines = stream_.warnings();
  if (damaged_ > 0) {
    lines.push_back(
        fmt::format("{} damaged frames were left out, of the saved recording, too", damaged_));
  }
  return lines;
}

void RecordingStream::finish() {
  waiting_.close();
  if (writer_.joinable()) writer_.join();
  if (failure_) std::rethrow_exception(failure_);
  if (next_id_ == 0) return;
  files_.write("camera.yaml", format_camera_yaml(camera_));
  files_.write("rgb.txt", rgb_list_);
  files_.write("depth.txt", depth_list_);
  files_.write("associations.txt", pairs_);
  files_.take_place();
}

}  // namespace stillmap
