// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/logged_frames.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "tooling/browser/scene_message.hpp"

namespace stillmap {
namespace {

std::optional<Eigen::Vector3d> vector_of(const nlohmann::json& json) {
  if (json.is_null()) return std::nullopt;
  return Eigen::Vector3d(
      json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

ViewedObject logged_object(const nlohmann::json& json) {
  const nlohmann::json& box = json.at("box");
  return {.track = json.at("track").get<std::uint32_t>(),
          .class_name = json.at("class").get<std::string>(),
          .dynamic = json.at("state").get<std::string>() == "dynamic",
          .motion = json.at("motion").get<std::string>(),
          .box = {box.at(0).get<double>(),
                  box.at(1).get<double>(),
                  box.at(2).get<double>(),
                  box.at(3).get<double>()},
          .p_world = vector_of(json.at("p_world")),
          .velocity_m_s = vector_of(json.at("v_world")).value_or(Eigen::Vector3d::Zero())};
}

ViewedFrame logged_frame(std::string_view line) {
  const nlohmann::json json = nlohmann::json::parse(line);
  ViewedFrame frame;
  frame.stamp.text = json.at("stamp").get<std::string>();
  frame.stamp.seconds = std::stod(frame.stamp.text);
  for (const nlohmann::json& object : json.at("objects")) {
    frame.objects.push_back(logged_object(object));
  }
  return frame;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<ViewedFrame> frames_of_objects(const LoggedRun& run, std::size_t most) {
  const std::vector<std::string_view> lines = lines_of(run.objects_jsonl);
  std::vector<ViewedFrame> frames;
  for (const std::size_t i : evenly_spread(lines.size(), most)) {
    try {
      frames.push_back(logged_frame(lines[i]));
      frames.back().number = static_cast<std::uint32_t>(i);
    } catch (const std::exception&) {
      throw Error(
          "{}:{}: expected a line of objects as `stillmap run` writes it", run.objects_name, i + 1);
    }
  }
  return frames;
}

std::vector<ViewedFrame> frames_of_trajectory(const LoggedRun& run, std::size_t most) {
  std::vector<Stamp> stamps = run.lost;
  for (const StampedPose& pose : run.trajectory) stamps.push_back(pose.stamp);
  std::ranges::stable_sort(stamps, {}, &Stamp::seconds);
  std::vector<ViewedFrame> frames;
  for (const std::size_t i : evenly_spread(stamps.size(), most)) {
    frames.emplace_back();
    frames.back().number = static_cast<std::uint32_t>(i);
    frames.back().stamp = stamps[i];
  }
  return frames;
}

void add_pose(ViewedFrame& frame,
              const Eigen::Isometry3d& T_world_camera,
              const std::optional<CameraModel>& camera) {
  frame.status = TrackingStatus::kTracked;
  frame.T_world_camera = T_world_camera;
  if (!camera) return;
  for (ViewedObject& object : frame.objects) {
    if (!object.p_world) continue;
    const double depth_m = (T_world_camera.inverse() * *object.p_world).z();
    object.size_m = seen_size(object.box, depth_m, std::nullopt, *camera);
  }
}

}  // namespace

std::vector<ViewedFrame> logged_frames(const LoggedRun& run, std::size_t most) {
  std::vector<ViewedFrame> frames =
      run.objects_jsonl.empty() ? frames_of_trajectory(run, most) : frames_of_objects(run, most);
  std::map<std::string, Eigen::Isometry3d> poses;
  for (const StampedPose& pose : run.trajectory) poses[pose.stamp.text] = pose.T_world_camera;
  std::set<std::string> keyframes;
  for (const StampedPose& pose : run.keyframes) keyframes.insert(pose.stamp.text);
  for (ViewedFrame& frame : frames) {
    frame.keyframe = keyframes.contains(frame.stamp.text);
    const auto pose = poses.find(frame.stamp.text);
    if (pose != poses.end()) add_pose(frame, pose->second, run.camera);
  }
  return frames;
}

std::size_t logged_drops(std::string_view report_json) {
  const nlohmann::json report = nlohmann::json::parse(report_json, nullptr, false);
  const nlohmann::json::json_pointer dropped("/live/dropped");
  if (!report.is_object() || !report.contains(dropped)) return 0;
  const nlohmann::json& count = report[dropped];
  return count.is_number_unsigned() ? count.get<std::size_t>() : 0;
}

}  // namespace stillmap
