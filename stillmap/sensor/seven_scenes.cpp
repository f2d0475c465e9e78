// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/seven_scenes.hpp"

#include <string_view>
#include <system_error>

#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/numbered_images.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kColor = ".color.png", kDepth = ".depth.png";

CameraModel seven_scenes_camera() {
  CameraModel camera;
  camera.name = "7-Scenes";
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = camera.fy = 585;
  camera.cx = 320;
  camera.cy = 240;
  camera.depth_factor = 1000;
  return camera;
}

fs::path pose_file(const fs::path& color) {
  const std::string name = color.filename().string();
  return color.parent_path() / (name.substr(0, name.size() - kColor.size()) + ".pose.txt");
}

}  // namespace

bool is_seven_scenes(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with("frame-") && name.ends_with(kColor)) return true;
  }
  return false;
}

SequenceContent open_seven_scenes(const fs::path& folder, const ReadingOptions& options) {
  SequenceContent content =
      pair_numbered(files_ending(folder, kColor), files_ending(folder, kDepth), folder, options);
  content.camera = seven_scenes_camera();
  if (!files_ending(folder, ".pose.txt").empty()) {
    content.groundtruth = [entries = content.entries] {
      return read_pose_files(entries, pose_file);
    };
  }
  return content;
}

}  // namespace stillmap
