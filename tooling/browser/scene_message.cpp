// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/scene_message.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double millimetres(double metres) {
  return std::round(metres * 1e3) / 1e3 + 0.0;
}

void add_layout(Json& json, const SceneLayout& layout) {
  Json level = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) level.push_back(layout.R_level_world(row, column));
  }
  json["level"] = std::move(level);
  json["spacing"] = layout.spacing_m;
  if (layout.box.isEmpty()) return;
  Json box = Json::array();
  for (const Eigen::Vector3d& corner : {layout.box.min(), layout.box.max()}) {
    for (const double coordinate : corner) box.push_back(millimetres(coordinate));
  }
  json["box"] = std::move(box);
  json["head"] = millimetres(layout.head_y);
}

}  // namespace

std::string start_json(const ViewStart& start) {
  Json json = {{"version", 2},
               {"title", start.title},
               {"frames", start.frames ? Json(*start.frames) : Json()},
               {"side", PointChunks::kSide_m}};
  if (start.step_s) json["step"] = millimetres(*start.step_s);
  if (start.camera) {
    const CameraModel& camera = *start.camera;
    json["camera"] = {{"width", camera.width_px},
                      {"height", camera.height_px},
                      {"fx", camera.fx},
                      {"fy", camera.fy},
                      {"cx", camera.cx},
                      {"cy", camera.cy}};
  }
  return dumped(json);
}

std::string state_json(const SceneState& state, std::size_t most_keyframes) {
  Json json = {{"dropped", state.dropped}, {"leftOut", state.left_out}};
  add_layout(json, state.layout);
  if (!state.finished) return dumped(json);
  Json keyframes = Json::array();
  for (const std::size_t i : evenly_spread(state.keyframes.size(), most_keyframes)) {
    keyframes.push_back(Json::parse(pose_json(state.keyframes[i].T_world_camera)));
  }
  json["keyframes"] = std::move(keyframes);
  json["finished"] = true;
  return dumped(json);
}

bool add_points(Message& message,
                const PointChunks& map,
                std::vector<std::size_t>& sent,
                std::size_t most) {
  sent.resize(map.chunks().size(), 0);
  Json parts = Json::array();
  std::size_t room = most;
  bool more = false;
  for (std::size_t i = 0; i < map.chunks().size(); ++i) {
    const PointChunk& chunk = map.chunks()[i];
    const std::size_t count = std::min(chunk.size() - sent[i], room);
    more = more || count < chunk.size() - sent[i];
    if (count == 0) continue;
    const auto positions = std::span(chunk.positions).subspan(3 * sent[i], 3 * count);
    const auto colors = std::span(chunk.colors).subspan(3 * sent[i], 3 * count);
    const std::size_t positions_at = message.attach(positions);
    const std::size_t colors_at = message.attach(colors);
    parts.push_back(
        {i, chunk.cell[0], chunk.cell[1], chunk.cell[2], count, positions_at, colors_at});
    sent[i] += count;
    room -= count;
  }
  if (!parts.empty()) message.add("points", dumped(parts));
  return more;
}

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t limit) {
  const std::size_t n = std::min(count, limit);
  std::vector<std::size_t> indexes(n);
  for (std::size_t i = 0; i < n; ++i) indexes[i] = i * count / n;
  return indexes;
}

}  // namespace stillmap
