// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "tooling/pipeline/object_log_codec.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written here

/// The value rounded to `decimals` decimals; never "-0.0".
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

/// The frame's final pose, and the inverse of the pose that it had when it was processed.
struct Move {
  Eigen::Isometry3d T_world_camera;
  Eigen::Isometry3d T_camera_then;
};

/// `to_final`: null for a frame without a final pose.
Json object_json(const ObjectState& state, const Move* to_final) {
  const Motion& motion = state.motion;
  std::optional<Eigen::Vector3d> p_world, v_world;
  if (to_final != nullptr) {
    if (motion.p_world) {
      p_world = to_final->T_world_camera * (to_final->T_camera_then * *motion.p_world);
    }
    if (motion.state != MotionState::kUnknown) {
      v_world = to_final->T_world_camera.linear() *
                (to_final->T_camera_then.linear() * motion.velocity_m_s);
    }
  }
  const PixelBox& box = state.box;
  return {{"track", state.track.value},
          {"class", state.class_name},
          {"category", category_name(state.category)},
          {"state", state.dynamic ? "dynamic" : "static"},
          {"reason", reason_name(state.reason)},
          {"motion", motion_name(motion.state)},
          {"by", track_json(motion.by)},
          {"person", track_json(state.person)},
          {"box", {rounded(box.x0, 1), rounded(box.y0, 1), rounded(box.x1, 1), rounded(box.y1, 1)}},
          {"filled", state.filled},
          {"p_world", vector_json(p_world, 4)},
          {"v_world", vector_json(v_world, 3)}};
}

/// The key with the highest count, the first of equals.
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

void count(TrackCounts& counts, const ObjectState& state) {
  ++counts.classes[state.class_name];
  ++counts.reasons[state.reason];
  ++counts.motions[state.motion.state];
  ObjectSummary& summary = counts.summary;
  summary.track = state.track.value;
  summary.category = category_name(state.category);
  ++summary.frames;
  summary.filled += state.filled ? 1 : 0;
  summary.dynamic += state.dynamic ? 1 : 0;
}

}  // namespace

void ObjectLog::on_frame(const RgbdFrame& /*frame*/, const FrameResult& result) {
  frames_.push_back(encode(LoggedFrame{{result.stamp, result.T_world_camera}, result.objects}));
}

void ObjectLog::visit(const std::function<void(const LoggedFrame& frame)>& visit) const {
  const auto rename = [this](TrackId& track) { track = lasting_.of(track); };
  frames_.visit([&](std::string_view bytes) {
    LoggedFrame frame = decode_logged_frame(bytes);
    for (ObjectState& state : frame.second) {
      rename(state.track);
      if (state.person) rename(*state.person);
      if (state.motion.by) rename(*state.motion.by);
    }
    visit(frame);
  });
}

std::string ObjectLog::jsonl(const Trajectory& final_poses) const {
  std::string text;
  auto pose = final_poses.begin();
  visit([&](const LoggedFrame& frame) {
    const auto& [then, states] = frame;
    while (pose != final_poses.end() && pose->stamp.seconds < then.stamp.seconds) ++pose;
    std::optional<Move> to_final;
    if (pose != final_poses.end() && pose->stamp.text == then.stamp.text) {
      to_final = Move{pose->T_world_camera, then.T_world_camera.inverse()};
    }
    Json objects = Json::array();
    for (const ObjectState& state : states) {
      objects.push_back(object_json(state, to_final ? &*to_final : nullptr));
    }
    const Json line = {{"stamp", then.stamp.text}, {"objects", std::move(objects)}};
    text += line.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  });
  return text;
}

std::vector<ObjectSummary> ObjectLog::summaries() const {
  std::map<TrackId, TrackCounts> tracks;
  visit([&](const LoggedFrame& frame) {
    std::set<TrackId> in_frame;  // a track may have several parts
    for (const ObjectState& state : frame.second) {
      if (in_frame.insert(state.track).second) count(tracks[state.track], state);
    }
  });
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
