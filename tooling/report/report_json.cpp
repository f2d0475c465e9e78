// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/report_json.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "tooling/eval/metrics_json.hpp"
#include "tooling/report/time_summary.hpp"
#include "tooling/report/tracking_gaps.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written here

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json distortion_json(const CameraModel& c) {
  if (c.lens == LensModel::kFisheye) return {c.k1, c.k2, c.k3, c.k4};
  if (c.k4 != 0 || c.k5 != 0 || c.k6 != 0) {
    return {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6};
  }
  return {c.k1, c.k2, c.p1, c.p2, c.k3};
}

Json camera_json(const CameraModel& camera, double depth_delay_s) {
  return {{"name", camera.name},
          {"width", camera.width_px},
          {"height", camera.height_px},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"lens", camera.lens == LensModel::kFisheye ? "fisheye" : "brown_conrady"},
          {"distortion", distortion_json(camera)},
          {"depth_factor", camera.depth_factor},
          {"readout_s", camera.readout_s},
          {"depth_delay_s", depth_delay_s}};
}

Json all_frames_json(const RunReport& report) {
  Json skipped = Json::array();
  for (const DamagedFrame& frame : report.skipped) {
    skipped.push_back({{"stamp", frame.stamp.text}, {"message", frame.damage}});
  }
  Json lost = Json::array();
  for (const Stamp& stamp : report.lost) lost.push_back(stamp.text);
  Json json = frames_json(report.frames_total, report.frames_tracked);
  json["skipped"] = skipped;
  json["lost"] = lost;
  json["elsewhere"] = report.frames_elsewhere;
  return json;
}

Json tracking_json(const RunReport& report) {
  Json gaps = Json::array();
  for (const TrackingGap& gap : tracking_gaps(report.lost, report.estimate)) {
    gaps.push_back({{"first_lost", gap.first_lost.text},
                    {"frames", gap.frames},
                    {"seconds", gap.seconds},
                    {"found_again", gap.found.has_value()},
                    {"found_at", gap.found ? Json(gap.found->text) : Json()},
                    {"moved_m", optional_json(gap.moved_m)}});
  }
  return {{"gaps", gaps}};
}

Json loops_json(const RunReport& report) {
  Json loops = Json::array();
  for (const ClosedLoop& loop : report.loops) {
    loops.push_back({{"earlier", loop.earlier.text}, {"later", loop.later.text}});
  }
  return loops;
}

Json times_json(std::span<const double> values) {
  const std::optional<TimeSummary> summary = summarize_times(values);
  return {{"mean", summary ? Json(summary->mean) : Json()},
          {"median", summary ? Json(summary->median) : Json()},
          {"p95", summary ? Json(summary->p95) : Json()},
          {"max", summary ? Json(summary->max) : Json()}};
}

Json time_json(const RunReport& report) {
  Json stages = Json::object();
  std::map<std::string, std::vector<double>> samples;
  for (const StageTimes& stage : report.stages) {
    std::vector<double>& all = samples[stage.name];
    all.insert(all.end(), stage.ms.begin(), stage.ms.end());
    stages[stage.name] = times_json(all);
  }
  return {{"wall_s", optional_json(report.wall_s)},
          {"frame_ms", times_json(report.frame_ms)},
          {"stages_ms", stages}};
}

Json live_json(const std::optional<LiveReport>& live) {
  if (!live) return nullptr;
  return {{"speed", optional_json(live->speed)},
          {"dropped", live->dropped},
          {"looked_at", live->looked_at},
          {"objects_age_frames", times_json(live->objects_age_frames)},
          {"latency_ms", times_json(live->latency_ms)}};
}

Json bounds_json(const PointCloud* map) {
  if (map == nullptr || map->empty()) return {{"bounds_min", nullptr}, {"bounds_max", nullptr}};
  Eigen::Vector3f low = map->positions.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& p : map->positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {{"bounds_min", {low.x(), low.y(), low.z()}},
          {"bounds_max", {high.x(), high.y(), high.z()}}};
}

Json vacated_json(const std::vector<VacatedPlace>& places) {
  Json all = Json::array();
  for (const VacatedPlace& place : places) {
    all.push_back({{"track", place.left.value},
                   {"found_as", place.found.value},
                   {"confidence", place.confidence},
                   {"removed", place.counts()}});
  }
  return all;
}

Json map_json(const RunReport& report) {
  const PointCloud* map = report.map;
  Json json = {{"points", map != nullptr ? Json(map->size()) : Json()}};
  json.update(bounds_json(map));
  json["poses"] = map != nullptr ? Json(report.map_at_true_poses ? "truth" : "estimated") : Json();
  json["vacated"] = vacated_json(report.vacated);
  json.update(map_quality_json(report.map_quality));
  return json;
}

/// Sums over objects of one kind; a sighting is an object in a frame.
struct ObjectCounts {
  std::size_t tracks = 0, sightings = 0, filled = 0, dynamic = 0;

  void add(const ObjectSummary& object) {
    ++tracks;
    sightings += object.frames;
    filled += object.filled;
    dynamic += object.dynamic;
  }
  [[nodiscard]] Json json() const {
    return {{"tracks", tracks}, {"sightings", sightings}, {"filled", filled}, {"dynamic", dynamic}};
  }
};

Json objects_json(const RunReport& report) {
  if (!report.objects) {
    return {{"tracks", nullptr},
            {"sightings", nullptr},
            {"filled", nullptr},
            {"dynamic", nullptr},
            {"first_dynamic_s", nullptr},
            {"classes", Json::object()}};
  }
  ObjectCounts all;
  std::map<std::string, ObjectCounts> classes;
  for (const ObjectSummary& object : *report.objects) {
    all.add(object);
    classes[object.class_name].add(object);
  }
  Json json = all.json();
  json["first_dynamic_s"] = optional_json(report.first_dynamic_s);
  json["classes"] = Json::object();
  for (const auto& [name, counts] : classes) json["classes"][name] = counts.json();
  return json;
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

}  // namespace

std::string report_json(const RunReport& report) {
  const Json json = {{"version", report.version},
                     {"sequence", report.sequence},
                     {"camera", camera_json(report.camera, report.depth_delay_s)},
                     {"frames", all_frames_json(report)},
                     {"tracking", tracking_json(report)},
                     {"keyframes", report.keyframes.size()},
                     {"loops", loops_json(report)},
                     {"time", time_json(report)},
                     {"memory", {{"peak_mb", optional_json(report.peak_memory_mb)}}},
                     {"live", live_json(report.live)},
                     {"ate", ate_json(report.ate)},
                     {"rpe", rpe_json(report.rpe)},
                     {"map", map_json(report)},
                     {"map_truth_poses", map_quality_json(report.map_quality_true_poses)},
                     {"dynamics",
                      {{"mode", text_or_null(report.dynamics_mode)},
                       {"matches_judged_by", report.matches_judged_by}}},
                     {"objects", objects_json(report)},
                     {"warnings", report.warnings}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace stillmap
