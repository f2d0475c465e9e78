// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/frame_reader.hpp"

#include <memory>
#include <utility>

#include "stillmap/core/error.hpp"

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

FrameReading FrameReader::read(const SequenceContent& content,
                               FrameId id,
                               const std::filesystem::path& place) const {
  const SequenceEntry& entry = content.entries[id.index()];
  const std::filesystem::path& color_place = entry.color_file.empty() ? place : entry.color_file;
  const std::filesystem::path& depth_place = entry.depth_file.empty() ? place : entry.depth_file;
  const std::string name = "camera '" + camera_.name + "'";
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = entry.stamp;
  frame.depth_stamp_s = entry.depth_stamp_s;
  ImagePair images = content.images->pair(id.index(), camera_.depth_factor);
  frame.color = std::move(images.color.color);
  check_image_size(frame.color.mat, camera_, color_place, name);
  frame.depth = std::move(images.depth);
  if (registration_) {
    const CameraModel& depth = camera_.depth_camera->camera;
    check_image_size(frame.depth.mat, depth, depth_place, "the depth camera of " + name);
    frame.depth = registration_->to_color(frame.depth);
  }
  check_image_size(frame.depth.mat, camera_, depth_place, name);
  frame.gray = to_gray(frame.color);
  return {std::make_shared<const RgbdFrame>(std::move(frame)), std::move(images.color.warning)};
}

}  // namespace stillmap
