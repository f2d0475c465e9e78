// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_parts.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxConfigSize = std::size_t{1} << 20U;
constexpr std::size_t kMaxClassName = 256;
constexpr std::size_t kMaxSurface = 4096;  // points of an object

bool is_known(const MapParts& map, KeyframeId id) {
  const auto keyframe = std::ranges::lower_bound(map.keyframes, id, {}, &Keyframe::id);
  if (keyframe != map.keyframes.end() && keyframe->id == id) return true;
  const auto dropped = std::ranges::lower_bound(
      map.dropped_keyframes, id, {}, &std::pair<KeyframeId, Anchor>::first);
  return dropped != map.dropped_keyframes.end() && dropped->first == id;
}

constexpr double kMaxDepthTime_s = 1;

// A description of the first mistake; null if there is none.
const char* cloud_problem(const CompactCloud& cloud) {
  const std::size_t size = cloud.size();
  if (cloud.colors.size() != size || (!cloud.labels.empty() && cloud.labels.size() != size)) {
    return "arrays of its points that differ in length";
  }
  constexpr auto kGreatest = static_cast<float>(kMaxCoordinate_m);
  for (int axis = 0; axis < 3; ++axis) {
    const float step = cloud.step[axis];
    const bool is_inside = std::abs(cloud.origin[axis]) <= kGreatest && step >= 0 &&
                           std::abs(cloud.origin[axis] + 65535 * step) <= kGreatest;
    if (!is_inside) return "where its points are";
  }
  return nullptr;
}

const char* range_problem(const RangeImage& range, const CameraModel& camera) {
  const bool none = range.columns == 0 && range.rows == 0 && range.cells.empty();
  if (range.block_px < 1 || range.block_px > camera.width_px + camera.height_px) {
    return "the size of its blocks";
  }
  const int columns = (camera.width_px + range.block_px - 1) / range.block_px;
  const int rows = (camera.height_px + range.block_px - 1) / range.block_px;
  if (!none &&
      (range.columns != columns || range.rows != rows ||
       range.cells.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))) {
    return "the size of its range image";
  }
  return nullptr;
}

void check_loops(const SessionParts& parts, const std::string& place) {
  for (std::size_t i = 0; i < parts.loops.size(); ++i) {
    const LoopEdge& loop = parts.loops[i];
    if (!is_known(parts.map, loop.a) || !is_known(parts.map, loop.b) || loop.a == loop.b) {
      throw Error("{}: invalid loop {}: its key frames", place, i);
    }
    const auto is_sigma = [](double s) { return s > 0 && s <= kMaxCoordinate_m; };
    if (!is_rigid(loop.T_a_b) || !is_sigma(loop.sigma_m) || !is_sigma(loop.sigma_rad)) {
      throw Error("{}: invalid loop {}: its pose", place, i);
    }
  }
}

void check_frames(const SessionParts& parts, const std::string& place) {
  std::size_t i = 0;
  for (const FrameRecord frame : parts.frames) {
    const char* problem = !is_stamp(frame.stamp)                  ? "its stamp"
                          : !is_known(parts.map, frame.reference) ? "its key frame"
                          : !is_rigid(frame.T_reference_frame)    ? "its pose"
                                                                  : nullptr;
    if (problem != nullptr) throw Error("{}: invalid frame {}: {}", place, i, problem);
    ++i;
  }
}

void check_views(const SessionParts& parts, const std::string& place) {
  for (std::size_t i = 0; i < parts.views.size(); ++i) {
    const ViewRecord& record = parts.views[i];
    const bool in_order = i == 0 || parts.views[i - 1].frame < record.frame;
    const char* problem = record.frame >= parts.frames.size() || !in_order ? "its frame" : nullptr;
    if (record.view == nullptr) problem = "it is empty";
    if (!(std::abs(record.depth_after_color_s) <= kMaxDepthTime_s)) problem = "its time";
    if (problem == nullptr) problem = cloud_problem(record.view->cloud);
    if (problem == nullptr) problem = range_problem(record.view->range, parts.camera);
    if (problem != nullptr) throw Error("{}: invalid view {}: {}", place, i, problem);
  }
}

const char* object_problem(const KnownObject& object) {
  const auto possible = [](const Eigen::Vector3d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
  };
  if (object.class_name.size() > kMaxClassName) return "its class";
  if (!std::isfinite(object.seen_s) || object.sightings < 0) return "its sightings";
  if (object.surface.size() > kMaxSurface || !std::ranges::all_of(object.surface, possible)) {
    return "its surface";
  }
  const bool seen = !object.extent.isEmpty();
  if (seen && !(possible(object.extent.min()) && possible(object.extent.max()))) {
    return "its extent";
  }
  if (!(object.extent_area_m2 >= 0) || !std::isfinite(object.extent_area_m2)) return "its area";
  const bool shares =
      std::ranges::all_of(object.colors, [](float share) { return share >= 0 && share <= 1; });
  return shares ? nullptr : "its colors";
}

void check_objects(const SessionParts& parts, const std::string& place) {
  for (std::size_t i = 0; i < parts.objects.size(); ++i) {
    const KnownObject& object = parts.objects[i];
    const bool in_order = i == 0 || parts.objects[i - 1].track < object.track;
    const char* problem =
        in_order && object.track.value <= kMaxId ? object_problem(object) : "its track";
    if (problem != nullptr) throw Error("{}: invalid object {}: {}", place, i, problem);
  }
}

}  // namespace

SessionParts parts_of(const Session& session) {
  return {session.camera,
          session.config_yaml,
          session.map.parts(),
          session.loops,
          session.frames,
          session.views,
          session.objects};
}

void check_records(const SessionParts& parts, const std::string& place) {
  check_camera(parts.camera, place);
  if (parts.config_yaml.size() > kMaxConfigSize) {
    throw Error("{}: invalid settings: {} bytes long", place, parts.config_yaml.size());
  }
  check_loops(parts, place);
  check_frames(parts, place);
  check_views(parts, place);
  check_objects(parts, place);
}

}  // namespace stillmap
