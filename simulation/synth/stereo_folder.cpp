// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/stereo_folder.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

std::string stamp_ns(const Stamp& stamp) {
  return fmt::format("{}", std::llround(stamp.seconds * 1e6) * 1000);  // stamps have microseconds
}

std::string sensor_yaml(const CameraModel& camera, double x_m, double rate_hz) {
  return fmt::format(
      "sensor_type: camera\n"
      "comment: rendered\n"
      "T_BS:\n"
      "  cols: 4\n"
      "  rows: 4\n"
      "  data: [1, 0, 0, {}, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n"
      "rate_hz: {}\n"
      "resolution: [{}, {}]\n"
      "camera_model: pinhole\n"
      "intrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [0, 0, 0, 0]\n",
      x_m,
      rate_hz,
      camera.width_px,
      camera.height_px,
      camera.fx,
      camera.fy,
      camera.cx,
      camera.cy);
}

std::string pose_row(const StampedPose& pose) {
  const Eigen::Vector3d t = pose.T_world_camera.translation();
  const Eigen::Quaterniond q(pose.T_world_camera.rotation());
  return fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                     stamp_ns(pose.stamp),
                     t.x(),
                     t.y(),
                     t.z(),
                     q.w(),
                     q.x(),
                     q.y(),
                     q.z());
}

}  // namespace

StereoFolder::StereoFolder(const SyntheticSequence& sequence,
                           const FolderReplacement& result,
                           double baseline_m)
    : sequence_(sequence), result_(result), baseline_m_(baseline_m) {
  STILLMAP_CHECK(baseline_m > 0);
}

void StereoFolder::write_pair(const RgbdFrame& frame) const {
  const std::string name = stamp_ns(frame.stamp) + ".png";
  result_.write("mav0/cam0/data/" + name, encode_png(frame.color));
  result_.write("mav0/cam1/data/" + name, encode_png(sequence_.right_image(frame.id, baseline_m_)));
}

void StereoFolder::write_lists() const {
  std::string images = "#timestamp [ns],filename\n";
  std::string poses = "#timestamp,p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  for (const StampedPose& pose : sequence_.ground_truth()) {
    images += fmt::format("{0},{0}.png\n", stamp_ns(pose.stamp));
    poses += pose_row(pose);
  }
  const double rate_hz = sequence_.options().frames_per_second;
  for (const auto& [camera, x_m] : {std::pair("cam0", 0.0), std::pair("cam1", baseline_m_)}) {
    const std::string folder = fmt::format("mav0/{}/", camera);
    result_.write(folder + "data.csv", images);
    result_.write(folder + "sensor.yaml", sensor_yaml(sequence_.camera(), x_m, rate_hz));
  }
  result_.write("mav0/state_groundtruth_estimate0/data.csv", poses);
}

}  // namespace stillmap
