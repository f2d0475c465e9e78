// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_view_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <nlohmann/json.hpp>

#include "tooling/report/page_text.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

void append_mm(Json& out, const Eigen::Vector3d& p) {
  for (int axis = 0; axis < 3; ++axis) out.push_back(std::round(p[axis] * 1000) / 1000);
}

Json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

struct QuantisedCloud {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d step = Eigen::Vector3d::Ones();
  std::vector<std::uint8_t> positions;  // 6 bytes a point
  std::vector<std::uint8_t> colors;     // 3
};

QuantisedCloud quantise(const PointCloud& map,
                        const std::vector<std::size_t>& chosen,
                        const Eigen::Matrix3d& R_level_world) {
  constexpr double kCodes = 65535;
  Eigen::AlignedBox3d box;
  for (const std::size_t i : chosen) box.extend(R_level_world * map.positions[i].cast<double>());
  QuantisedCloud cloud;
  if (chosen.empty()) return cloud;
  cloud.low = box.min();
  cloud.step = (box.sizes() / kCodes).cwiseMax(1e-9);  // flat clouds have an axis without size
  for (const std::size_t i : chosen) {
    const Eigen::Vector3d p = R_level_world * map.positions[i].cast<double>();
    for (int axis = 0; axis < 3; ++axis) {
      const double code = std::round((p[axis] - cloud.low[axis]) / cloud.step[axis]);
      const std::uint32_t bits = static_cast<std::uint32_t>(std::clamp(code, 0.0, kCodes));
      cloud.positions.push_back(static_cast<std::uint8_t>(bits & 255U));
      cloud.positions.push_back(static_cast<std::uint8_t>(bits >> 8U));
    }
    cloud.colors.insert(cloud.colors.end(), map.colors[i].begin(), map.colors[i].end());
  }
  return cloud;
}

Json paths_json(const Trajectory& cameras, const Eigen::Matrix3d& R_level_world) {
  constexpr std::size_t kMostPoints = 5000;  // of one part
  Json paths = Json::array();
  for (const std::vector<Eigen::Vector3d>& part : continuous_parts(cameras)) {
    Json path = Json::array();
    for (const std::size_t i : evenly_spread(part.size(), kMostPoints))
      append_mm(path, R_level_world * part[i]);
    paths.push_back(path);
  }
  return paths;
}

// A pyramid of eight edges for each key frame: pairs of ends, three coordinates each.
Json frusta_json(const Trajectory& keyframes, const Eigen::Matrix3d& R_level_world) {
  constexpr std::size_t kMostFrusta = 300;
  constexpr double kDepth_m = 0.08;
  const std::array<Eigen::Vector3d, 4> corners = {Eigen::Vector3d(-0.8, -0.6, 1),
                                                  Eigen::Vector3d(0.8, -0.6, 1),
                                                  Eigen::Vector3d(0.8, 0.6, 1),
                                                  Eigen::Vector3d(-0.8, 0.6, 1)};
  Json lines = Json::array();
  for (const std::size_t i : evenly_spread(keyframes.size(), kMostFrusta)) {
    const Eigen::Isometry3d& T = keyframes[i].T_world_camera;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector3d corner = R_level_world * (T * (kDepth_m * corners[k]));
      const Eigen::Vector3d next = R_level_world * (T * (kDepth_m * corners[(k + 1) % 4]));
      append_mm(lines, R_level_world * T.translation());
      append_mm(lines, corner);
      append_mm(lines, corner);
      append_mm(lines, next);
    }
  }
  return lines;
}

Json view_json(const SceneFrame& scene) {
  const View view = view_along(scene, 1600, 900);
  const Eigen::Vector3d target = scene.box.isEmpty()
                                     ? Eigen::Vector3d(0, 0, 1)
                                     : Eigen::Vector3d(scene.box.merged(scene.cameras).center());
  const Eigen::Vector3d eye = scene.R_level_world * view.T_camera_world.inverse().translation();
  const Eigen::Vector3d back = eye - target;
  const double distance = std::max(back.norm(), 0.1);
  return {{"target", vector_json(target)},
          {"distance", distance},
          {"yaw", std::atan2(back.x(), -back.z())},
          {"pitch", std::asin(std::clamp(-back.y() / distance, -1.0, 1.0))},
          {"tan_half_fov", 0.5 * view.height_px / view.scale}};
}

}  // namespace

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t limit) {
  const std::size_t n = std::min(count, limit);
  std::vector<std::size_t> indexes(n);
  for (std::size_t i = 0; i < n; ++i) indexes[i] = i * count / n;
  return indexes;
}

std::vector<std::vector<Eigen::Vector3d>> continuous_parts(const Trajectory& poses) {
  constexpr double kGap_s = 0.5;
  std::vector<std::vector<Eigen::Vector3d>> parts;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i == 0 || poses[i].stamp.seconds - poses[i - 1].stamp.seconds > kGap_s)
      parts.emplace_back();
    parts.back().push_back(poses[i].T_world_camera.translation());
  }
  return parts;
}

std::string map_view_json(const PointCloud& map,
                          const SceneFrame& scene,
                          const Trajectory& cameras,
                          const Trajectory& keyframes,
                          std::size_t limit) {
  const std::vector<std::size_t> inside = points_in_scene(map, scene);
  std::vector<std::size_t> chosen;
  for (const std::size_t i : evenly_spread(inside.size(), limit)) chosen.push_back(inside[i]);
  const QuantisedCloud cloud = quantise(map, chosen, scene.R_level_world);
  const double thinning = static_cast<double>(inside.size()) /
                          static_cast<double>(std::max<std::size_t>(chosen.size(), 1));
  const Json json = {{"points", chosen.size()},
                     {"low", vector_json(cloud.low)},
                     {"step", vector_json(cloud.step)},
                     {"spacing", scene.spacing_m * std::sqrt(std::max(thinning, 1.0))},
                     {"view", view_json(scene)},
                     {"head_y", head_height(scene)},
                     {"paths", paths_json(cameras, scene.R_level_world)},
                     {"frusta", frusta_json(keyframes, scene.R_level_world)},
                     {"positions", base64(cloud.positions)},
                     {"colors", base64(cloud.colors)}};
  return json.dump();
}

}  // namespace stillmap
