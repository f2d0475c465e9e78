// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/frame_reader.hpp"

#include <memory>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

void check_image_size(const cv::Mat& image,
                      const CameraModel& camera,
                      const std::filesystem::path& file,
                      const std::string& whose) {
  if (image.cols == camera.width_px && image.rows == camera.height_px) return;
  throw Error("{}: {}x{} pixels, expected {}x{} as {} has",
              file.string(),
              image.cols,
              image.rows,
              camera.width_px,
              camera.height_px,
              whose);
}

}  // namespace

FrameReader::FrameReader(const CameraModel& camera) : camera_(camera) {
  if (camera.depth_camera) registration_.emplace(camera);
}

FramePtr FrameReader::read(const SequenceEntry& files, FrameId id) const {
  const std::string name = "camera '" + camera_.name + "'";
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = files.stamp;
  frame.depth_stamp_s = files.depth_stamp_s;
  frame.color = read_color(files.color_file);
  check_image_size(frame.color.mat, camera_, files.color_file, name);
  frame.depth = read_depth(files.depth_file, camera_.depth_factor);
  if (registration_) {
    const CameraModel& depth = camera_.depth_camera->camera;
    check_image_size(frame.depth.mat, depth, files.depth_file, "the depth camera of " + name);
    frame.depth = registration_->to_color(frame.depth);
  }
  check_image_size(frame.depth.mat, camera_, files.depth_file, name);
  frame.gray = to_gray(frame.color);
  return std::make_shared<const RgbdFrame>(std::move(frame));
}

}  // namespace stillmap
