// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/sequence.hpp"

#include <cstdlib>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {

CameraModel synthetic_camera(int width_px, int height_px) {
  const CameraModel original = builtin_camera("tum_fr3");
  const double x_scale = static_cast<double>(width_px) / original.width_px;
  const double y_offset = original.cy + 0.5 - 0.5 * original.height_px;
  CameraModel camera;
  camera.name = "synthetic";
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx = original.fx * x_scale;
  camera.fy = original.fy * x_scale;
  camera.cx = (original.cx + 0.5) * x_scale - 0.5;
  camera.cy = 0.5 * height_px + y_offset * x_scale - 0.5;
  return camera;
}

SyntheticSequence::SyntheticSequence(const SyntheticOptions& options)
    : options_(options),
      renderer_(std::make_shared<const Scene>(make_room(options.seed)), options.camera) {
  STILLMAP_CHECK(options.frames_per_second > 0);
}

Stamp SyntheticSequence::stamp(FrameId id) const {
  constexpr double kStart = 1000.0;
  Stamp stamp;
  stamp.text = fmt::format("{:.6f}", kStart + id.value / options_.frames_per_second);
  stamp.seconds = std::strtod(stamp.text.c_str(), nullptr);  // the number that a reader would get
  return stamp;
}

Eigen::Isometry3d SyntheticSequence::pose(FrameId id) const {
  return T_world_camera(options_.path, id.value / options_.frames_per_second);
}

FramePtr SyntheticSequence::frame(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  const RenderedImage image =
      apply_sensor(renderer_.render(pose(id)), options_.camera, options_.sensor, options_.seed, id);
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = stamp(id);
  frame.depth_stamp_s = frame.stamp.seconds;
  frame.color = image.color;
  frame.depth = image.depth;
  cv::cvtColor(image.color.mat, frame.gray.mat, cv::COLOR_RGB2GRAY);
  return std::make_shared<const RgbdFrame>(std::move(frame));
}

Trajectory SyntheticSequence::ground_truth() const {
  Trajectory trajectory;
  trajectory.reserve(size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    trajectory.push_back({stamp(FrameId(i)), pose(FrameId(i))});
  }
  return trajectory;
}

}  // namespace stillmap
