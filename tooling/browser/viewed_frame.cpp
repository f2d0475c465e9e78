// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/viewed_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

// With three decimals: a millimetre, where it is metres.
Json short_number(double value) {
  return std::round(value * 1e3) / 1e3 + 0.0;
}

Json short_vector(const Eigen::Vector3d& v) {
  return {short_number(v.x()), short_number(v.y()), short_number(v.z())};
}

Json pose_numbers(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  Json numbers = Json::array();
  for (const double value : {T.translation().x(),
                             T.translation().y(),
                             T.translation().z(),
                             q.x(),
                             q.y(),
                             q.z(),
                             q.w()}) {
    numbers.push_back(std::round(value * 1e5) / 1e5 + 0.0);
  }
  return numbers;
}

Json object_record(const ViewedObject& object) {
  const PixelBox& box = object.box;
  Json record = {
      {"i", object.track},
      {"c", object.class_name},
      {"b", {std::lround(box.x0), std::lround(box.y0), std::lround(box.x1), std::lround(box.y1)}},
      {"m", object.motion}};
  if (object.dynamic) record["d"] = 1;
  if (object.p_world) {
    record["p"] = short_vector(*object.p_world);
    record["v"] = short_vector(object.velocity_m_s);
    record["z"] = short_vector(object.size_m);
  }
  return record;
}

const char* status_word(TrackingStatus status) {
  constexpr std::array<const char*, 4> kWords = {"begun", "tracked", "found again", "lost"};
  return kWords.at(static_cast<std::size_t>(status));
}

}  // namespace

Eigen::Vector3d seen_size(const PixelBox& box,
                          double distance_m,
                          const std::optional<DepthInterval>& depths,
                          const CameraModel& camera) {
  const double width_m = box.width() * distance_m / camera.fx;
  const double height_m = box.height() * distance_m / camera.fy;
  const double forward_m =
      depths ? static_cast<double>(depths->max_m) - static_cast<double>(depths->min_m)
             : width_m / 2;
  return {width_m, height_m, std::clamp(forward_m, 0.1, 1.0)};
}

ViewedFrame viewed_frame(const FrameResult& result, const CameraModel& camera) {
  ViewedFrame frame{.number = result.id.value,
                    .stamp = result.stamp,
                    .status = result.status,
                    .T_world_camera = result.T_world_camera,
                    .keyframe = result.is_keyframe,
                    .pose_ms = result.pose_ms,
                    .tracked_features = result.tracked_features,
                    .objects = {}};
  for (const ObjectState& state : result.objects) {
    frame.objects.push_back(
        {.track = state.track.value,
         .class_name = state.class_name,
         .dynamic = state.dynamic,
         .motion = std::string(motion_name(state.motion.state)),
         .box = state.box,
         .p_world = state.motion.p_world,
         .velocity_m_s = state.motion.velocity_m_s,
         .size_m = seen_size(
             state.box, static_cast<double>(state.median_depth_m), state.depths, camera)});
  }
  return frame;
}

std::string pose_json(const Eigen::Isometry3d& T_world_camera) {
  return pose_numbers(T_world_camera).dump();
}

std::string frame_json(const ViewedFrame& frame) {
  Json record = {{"n", frame.number},
                 {"t", frame.stamp.seconds},
                 {"s", status_word(frame.status)},
                 {"ms", short_number(frame.pose_ms)},
                 {"f", frame.tracked_features}};
  if (frame.keyframe) record["k"] = 1;
  if (frame.status != TrackingStatus::kLost) record["p"] = pose_numbers(frame.T_world_camera);
  Json objects = Json::array();
  for (const ViewedObject& object : frame.objects) objects.push_back(object_record(object));
  if (!objects.empty()) record["o"] = std::move(objects);
  return record.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace stillmap
