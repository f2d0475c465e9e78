// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/icl_nuim.hpp"

#include <string>
#include <string_view>
#include <system_error>

#include <Eigen/Core>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/tum_lists.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// The first file, in the order of names, that begins and ends so; empty where there is none.
fs::path first_file(const fs::path& folder, std::string_view begin, std::string_view ending) {
  fs::path first;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool fits = name.starts_with(begin) && name.ends_with(ending);
    if (fits && (first.empty() || at->path() < first)) first = at->path();
  }
  return first;
}

fs::path poses_file(const fs::path& folder) {
  return first_file(folder, "", ".gt.freiburg");
}

CameraModel icl_nuim_camera() {
  CameraModel camera;
  camera.name = "ICL-NUIM";
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = 481.2;
  camera.fy = 480;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.depth_factor = 5000;
  return camera;
}

// Reflects y in both the world and the camera frame, which keeps rotations rotations.
Eigen::Isometry3d reflected(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d down(1, -1, 1);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = down.asDiagonal() * T.linear() * down.asDiagonal();
  result.translation() = down.asDiagonal() * T.translation();
  return result;
}

}  // namespace

bool is_icl_nuim(const fs::path& folder) {
  return (!pairs_file(folder).empty() && !poses_file(folder).empty()) ||
         !first_file(folder, "scene_", ".depth").empty();
}

SequenceContent open_icl_nuim(const fs::path& folder, const ReadingOptions& options) {
  const fs::path original = first_file(folder, "scene_", ".depth");
  if (!original.empty()) {
    throw Error(
        "{}: depth along the ray, of the renderer's own files, is not read; get the "
        "\"TUM RGB-D compatible PNGs\" of the sequence",
        original.string());
  }
  SequenceContent content = open_tum_lists(folder, options);
  content.camera = icl_nuim_camera();
  const fs::path poses = poses_file(folder);
  if (poses.empty()) return content;
  content.groundtruth = [poses, options] {
    GroundTruth truth = read_groundtruth(poses, options);
    for (StampedPose& pose : truth.poses) pose.T_world_camera = reflected(pose.T_world_camera);
    return truth;
  };
  return content;
}

}  // namespace stillmap
