// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/moving_points.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "stillmap/core/append_bytes.hpp"
#include "stillmap/core/error.hpp"
#include "tooling/pipeline/lasting_tracks.hpp"

namespace stillmap {
namespace {

constexpr int kStep_px = 4;       // every fourth pixel of every fourth row
constexpr float kReach_m = 0.6F;  // of an object, before and behind its middle

/// The depths of an object.
struct Reach {
  float nearest_m = 0, farthest_m = 0;
};

/// Of each object, by its number in the mask: masks also show what is behind the object at its rim.
std::vector<Reach> reaches(const cv::Mat1f& depth, const cv::Mat1b& mask) {
  std::vector<std::vector<float>> depths(256);
  for (int v = 0; v < mask.rows; v += kStep_px) {
    for (int u = 0; u < mask.cols; u += kStep_px) {
      if (mask(v, u) != 0 && depth(v, u) > 0) depths[mask(v, u)].push_back(depth(v, u));
    }
  }
  std::vector<Reach> all(depths.size());
  for (std::size_t id = 0; id < depths.size(); ++id) {
    std::vector<float>& some = depths[id];
    if (some.empty()) continue;
    const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::ranges::nth_element(some, middle);
    all[id] = {std::max(*middle - kReach_m, 0.0F), *middle + kReach_m};
  }
  return all;
}

}  // namespace

MovingPoints::MovingPoints(const CameraModel& camera) : rays_(pixel_rays(camera)) {}

void MovingPoints::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  if (!has_pose(result) || result.object_mask.mat.empty()) return;
  STILLMAP_CHECK(frame.depth.mat.size() == rays_.size());
  const std::vector<Reach> reach = reaches(frame.depth.mat, result.object_mask.mat);
  Frame kept{result.stamp, {}};
  for (int v = 0; v < rays_.rows; v += kStep_px) {
    for (int u = 0; u < rays_.cols; u += kStep_px) {
      const std::size_t id = result.object_mask.mat(v, u);
      const float z = frame.depth.mat(v, u);
      if (id == 0 || !(z > reach[id].nearest_m && z < reach[id].farthest_m)) continue;
      const ObjectState& object = result.objects[id - 1];
      if (!object.dynamic) continue;
      const cv::Vec2f& ray = rays_(v, u);
      const cv::Vec3b& rgb = frame.color.mat(v, u);
      kept.points.push_back({{ray[0] * z, ray[1] * z, z},
                             {rgb[0], rgb[1], rgb[2]},
                             object.track,
                             static_cast<std::uint8_t>(id - 1)});
    }
  }
  if (!kept.points.empty()) frames_.push_back(std::move(kept));
}

void MovingPoints::on_end(const RunResult& result) {
  const LastingTracks lasting(result.united_tracks);
  for (Frame& frame : frames_) {
    for (Point& point : frame.points) point.track = lasting.of(point.track);
  }
}

std::vector<StampedGhosts> MovingPoints::ghosts(std::size_t most) const {
  std::size_t points = 0;
  for (const Frame& frame : frames_) points += frame.points.size();
  std::vector<StampedGhosts> all;
  std::size_t before = 0;
  for (const Frame& frame : frames_) {
    StampedGhosts kept{frame.stamp, {}};
    for (const Point& point : frame.points) {
      // One is taken where the share of `most` that is due reaches the next whole number.
      const bool is_taken = points <= most || (before + 1) * most / points > before * most / points;
      if (is_taken) kept.points.add(point.p_camera, point.color, point.place);
      ++before;
    }
    all.push_back(std::move(kept));
  }
  return all;
}

std::string MovingPoints::ply(const Trajectory& final_poses) const {
  std::map<std::string, const Eigen::Isometry3d*> pose_of;
  for (const StampedPose& pose : final_poses) pose_of[pose.stamp.text] = &pose.T_world_camera;
  std::string points;
  std::size_t count = 0;
  for (const Frame& frame : frames_) {
    const auto pose = pose_of.find(frame.stamp.text);
    if (pose == pose_of.end()) continue;
    for (const Point& point : frame.points) {
      const Eigen::Vector3f p = (*pose->second * point.p_camera.cast<double>()).cast<float>();
      for (const float value : p) append_bytes(points, value);
      for (const std::uint8_t value : point.color) append_bytes(points, value);
      append_bytes(points, static_cast<std::int32_t>(point.track.value));
      append_bytes(points, frame.stamp.seconds);
      ++count;
    }
  }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n"
             "property int track\nproperty double stamp\nend_header\n",
             count) +
         points;
}

}  // namespace stillmap
