// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/landmark_creation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {
namespace {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit, in the world
};

Ray feature_ray(const CameraModel& camera, const Keyframe& keyframe, std::uint32_t feature) {
  const Eigen::Vector2d px = keyframe.features->px[feature].cast<double>();
  return {keyframe.T_world_camera.translation(),
          (keyframe.T_world_camera.linear() * camera.unproject(px, 1.0)).normalized()};
}

// The point midway between two rays; nothing where they do not meet before both cameras.
std::optional<Eigen::Vector3d> intersect(const Ray& a, const Ray& b) {
  const Eigen::Vector3d offset = b.origin - a.origin;
  const double c = a.direction.dot(b.direction);
  const double denominator = 1.0 - c * c;
  if (denominator < 1e-9) return std::nullopt;
  const double along_a = (offset.dot(a.direction) - c * offset.dot(b.direction)) / denominator;
  const double along_b = (c * offset.dot(a.direction) - offset.dot(b.direction)) / denominator;
  if (along_a <= 0 || along_b <= 0) return std::nullopt;
  return 0.5 * (a.origin + along_a * a.direction + b.origin + along_b * b.direction);
}

bool agrees(const CameraModel& camera,
            const MeasurementModel& measure,
            const Keyframe& keyframe,
            std::uint32_t feature,
            const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_camera = keyframe.T_world_camera.inverse() * p_world;
  return agrees_with(camera, measure(*keyframe.features, feature), p_camera);
}

// Fundamental matrix: p_b^T F p_a = 0 for ideal pixels of the two views.
Eigen::Matrix3d fundamental(const CameraModel& camera, const Keyframe& a, const Keyframe& b) {
  const Eigen::Isometry3d T_b_a = b.T_world_camera.inverse() * a.T_world_camera;
  Eigen::Matrix3d K_inverse;
  K_inverse << 1 / camera.fx, 0, -camera.cx / camera.fx, 0, 1 / camera.fy, -camera.cy / camera.fy,
      0, 0, 1;
  return K_inverse.transpose() * skew(T_b_a.translation()) * T_b_a.linear() * K_inverse;
}

// Features of a key frame that see no landmark.
std::vector<std::uint32_t> free_features(const Keyframe& keyframe) {
  std::vector<std::uint32_t> free;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!keyframe.landmarks[i].valid()) free.push_back(i);
  }
  return free;
}

// The free feature of `b` that looks most like feature `i` of `a` and lies on its epipolar line.
STILLMAP_POPCOUNT_CLONES
std::optional<std::uint32_t> match_on_line(const Eigen::Vector3d& line,
                                           const Descriptor& descriptor,
                                           const Features& b,
                                           std::span<const std::uint32_t> free_b,
                                           const std::vector<float>& level_scales,
                                           const LandmarkCreationConfig& config) {
  const double norm = std::hypot(line.x(), line.y());
  int best = config.max_distance + 1;
  std::optional<std::uint32_t> match;
  for (const std::uint32_t j : free_b) {
    const int distance = hamming_distance(descriptor, b.descriptors[j]);
    if (distance >= best) continue;
    const Eigen::Vector2d px = b.px[j].cast<double>();
    const double off = std::abs(line.x() * px.x() + line.y() * px.y() + line.z()) / norm;
    if (off > config.max_line_px * static_cast<double>(level_scales[b.level[j]])) continue;
    best = distance;
    match = j;
  }
  return match;
}

// Triangulates what two key frames see in common; returns how many landmarks that gave.
int triangulate_pair(Map& map,
                     KeyframeId a_id,
                     KeyframeId b_id,
                     const CameraModel& camera,
                     const MeasurementModel& measure,
                     const LandmarkCreationConfig& config) {
  const Keyframe& a = map.keyframe(a_id);
  const Keyframe& b = map.keyframe(b_id);
  const Eigen::Matrix3d F = fundamental(camera, a, b);
  const double max_cosine = std::cos(config.min_parallax_deg * std::numbers::pi / 180.0);
  const std::vector<std::uint32_t> free_b = free_features(b);
  int made = 0;
  for (const std::uint32_t i : free_features(a)) {
    const Eigen::Vector3d line = F * a.features->px[i].cast<double>().homogeneous();
    const std::optional<std::uint32_t> j = match_on_line(
        line, a.features->descriptors[i], *b.features, free_b, measure.level_scales(), config);
    if (!j || b.landmarks[*j].valid()) continue;
    const Ray ray_a = feature_ray(camera, a, i), ray_b = feature_ray(camera, b, *j);
    if (ray_a.direction.dot(ray_b.direction) > max_cosine) continue;
    const std::optional<Eigen::Vector3d> p_world = intersect(ray_a, ray_b);
    if (!p_world || !agrees(camera, measure, a, i, *p_world) ||
        !agrees(camera, measure, b, *j, *p_world)) {
      continue;
    }
    const LandmarkId id = map.add_landmark(*p_world, {a_id, i});
    map.add_observation(id, {b_id, *j});
    map.refresh(id);
    ++made;
  }
  return made;
}

}  // namespace

void create_landmarks_from_depth(Map& map,
                                 KeyframeId keyframe,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure,
                                 const LandmarkCreationConfig& config) {
  const Keyframe& source = map.keyframe(keyframe);
  const Features& features = *source.features;
  std::vector<std::uint32_t> order;
  for (const std::uint32_t i : free_features(source)) {
    if (measure.has_depth(features, i)) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return features.depth_m[i]; });
  int made = 0;
  for (const std::uint32_t i : order) {
    const double depth = static_cast<double>(features.depth_m[i]);
    if (depth > config.max_depth_m && made >= config.min_landmarks) break;
    const Eigen::Vector3d p_camera = camera.unproject(features.px[i].cast<double>(), depth);
    map.add_landmark(source.T_world_camera * p_camera, {keyframe, i});
    ++made;
  }
}

int triangulate_landmarks(Map& map,
                          KeyframeId keyframe,
                          const CameraModel& camera,
                          const MeasurementModel& measure,
                          const LandmarkCreationConfig& config) {
  int made = 0, tried = 0;
  for (const CovisibleKeyframe& neighbor : covisible_keyframes(map, keyframe)) {
    if (tried++ >= config.neighbors) break;
    made += triangulate_pair(map, keyframe, neighbor.id, camera, measure, config);
  }
  return made;
}

}  // namespace stillmap
