// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written here

/// With this many decimals; never "-0.0".
Json rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale + 0.0;
}

Json vector_json(const std::optional<Eigen::Vector3d>& v, int decimals) {
  if (!v) return nullptr;
  return {rounded(v->x(), decimals), rounded(v->y(), decimals), rounded(v->z(), decimals)};
}

Json track_json(const std::optional<TrackId>& track) {
  return track ? Json(track->value) : Json();
}

Json object_json(const LoggedObject& object, const Eigen::Isometry3d* T_world_camera) {
  std::optional<Eigen::Vector3d> p_world, v_world;
  if (T_world_camera != nullptr) {
    if (object.p_camera) p_world = *T_world_camera * *object.p_camera;
    if (object.v_camera_m_s) v_world = T_world_camera->linear() * *object.v_camera_m_s;
  }
  const ObjectState& state = object.state;
  const PixelBox& box = state.box;
  return {{"track", state.track.value},
          {"class", state.class_name},
          {"category", category_name(state.category)},
          {"state", state.dynamic ? "dynamic" : "static"},
          {"reason", reason_name(state.reason)},
          {"motion", motion_name(state.motion.state)},
          {"by", track_json(state.motion.by)},
          {"person", track_json(state.person)},
          {"box", {rounded(box.x0, 1), rounded(box.y0, 1), rounded(box.x1, 1), rounded(box.y1, 1)}},
          {"filled", state.filled},
          {"p_world", vector_json(p_world, 4)},
          {"v_world", vector_json(v_world, 3)}};
}

/// The key that was counted most often, the first of equals.
template <class Key>
Key most_frequent(const std::map<Key, std::size_t>& counts) {
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::ranges::max_element(counts, less)->first;
}

struct TrackCounts {
  std::map<std::string, std::size_t> classes;
  std::map<StateReason, std::size_t> reasons;
  std::map<MotionState, std::size_t> motions;
  ObjectSummary summary;
};

void count(TrackCounts& counts, const LoggedObject& object) {
  ++counts.classes[object.state.class_name];
  ++counts.reasons[object.state.reason];
  ++counts.motions[object.state.motion.state];
  ObjectSummary& summary = counts.summary;
  summary.track = object.state.track.value;
  summary.category = category_name(object.state.category);
  ++summary.frames;
  summary.filled += object.state.filled ? 1 : 0;
  summary.dynamic += object.state.dynamic ? 1 : 0;
}

}  // namespace

LoggedFrame log_frame(const FrameResult& result) {
  const Eigen::Isometry3d T_camera_world = result.T_world_camera.inverse();
  LoggedFrame frame{result.stamp, {}};
  for (const ObjectState& state : result.objects) {
    LoggedObject object{state, {}, {}};
    const Motion& motion = state.motion;
    if (motion.p_world) object.p_camera = T_camera_world * *motion.p_world;
    if (motion.state != MotionState::kUnknown) {
      object.v_camera_m_s = T_camera_world.linear() * motion.velocity_m_s;
    }
    frame.objects.push_back(std::move(object));
  }
  return frame;
}

std::string objects_jsonl(std::span<const LoggedFrame> frames, const Trajectory& final_poses) {
  std::string text;
  auto pose = final_poses.begin();
  for (const LoggedFrame& frame : frames) {
    while (pose != final_poses.end() && pose->stamp.seconds < frame.stamp.seconds) ++pose;
    const bool posed = pose != final_poses.end() && pose->stamp.text == frame.stamp.text;
    Json objects = Json::array();
    for (const LoggedObject& object : frame.objects) {
      objects.push_back(object_json(object, posed ? &pose->T_world_camera : nullptr));
    }
    const Json line = {{"stamp", frame.stamp.text}, {"objects", std::move(objects)}};
    text += line.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  }
  return text;
}

std::vector<ObjectSummary> summarize_objects(std::span<const LoggedFrame> frames) {
  std::map<TrackId, TrackCounts> tracks;
  for (const LoggedFrame& frame : frames) {
    for (const LoggedObject& object : frame.objects) count(tracks[object.state.track], object);
  }
  std::vector<ObjectSummary> summaries;
  for (auto& [track, counts] : tracks) {
    ObjectSummary& summary = counts.summary;
    summary.class_name = most_frequent(counts.classes);
    summary.main_reason = reason_name(most_frequent(counts.reasons));
    for (const auto& [motion, times] : counts.motions) {
      summary.motions.push_back({std::string(motion_name(motion)), times});
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace stillmap
