// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/inpainted_folder.hpp"

#include <system_error>

#include <fmt/core.h>
#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

void make_folders(const std::filesystem::path& folder) {
  std::error_code failure;
  if (std::filesystem::exists(folder, failure) && !std::filesystem::is_empty(folder, failure)) {
    throw Error("{}: is not empty; name a new folder", folder.string());
  }
  for (const char* name : {"rgb", "depth"}) {
    std::filesystem::create_directories(folder / name, failure);
    if (failure) {
      throw Error("{}: cannot make this folder ({}); choose another folder",
                  folder.string(),
                  failure.message());
    }
  }
}

/// All pixels that the run took for dynamic; empty in a mode that takes none for it.
Mask dynamic_pixels(const FrameResult& result) {
  if (result.excluded.empty()) return {};
  cv::Mat1b pixels = result.excluded.mat | result.extended_mask.mat;
  pixels |= result.depth_jumps.mat;
  return Mask(pixels);
}

}  // namespace

InpaintedFolder::InpaintedFolder(const std::filesystem::path& folder, const CameraModel& camera)
    : folder_(folder), camera_(camera), inpainter_(camera) {
  make_folders(folder);
}

void InpaintedFolder::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  if (!has_pose(result)) return;
  const Mask dynamic = dynamic_pixels(result);
  const InpaintedFrame painted = inpainter_.inpaint(frame, dynamic, result.T_world_camera);
  if (result.is_keyframe) inpainter_.add_keyframe(frame, dynamic, result.T_world_camera);
  const std::string name = frame.stamp.text + ".png";
  write_file_atomically(folder_ / "rgb" / name, encode_png(painted.color));
  write_file_atomically(folder_ / "depth" / name,
                        encode_depth_png(painted.depth, camera_.depth_factor));
  rgb_list_ += fmt::format("{} rgb/{}\n", frame.stamp.text, name);
  depth_list_ += fmt::format("{} depth/{}\n", frame.stamp.text, name);
}

void InpaintedFolder::on_end(const RunResult& /*result*/) {
  write_file_atomically(folder_ / "camera.yaml", format_camera_yaml(camera_));
  write_file_atomically(folder_ / "rgb.txt", rgb_list_);
  write_file_atomically(folder_ / "depth.txt", depth_list_);
}

}  // namespace stillmap
