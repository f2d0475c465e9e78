// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/merge_sessions.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/session/append.hpp"
#include "stillmap/session/session_cloud.hpp"
#include "stillmap/session/session_map.hpp"
#include "stillmap/slam/loop/global_adjustment.hpp"
#include "stillmap/slam/loop/loop_closer.hpp"
#include "stillmap/slam/loop/loop_detector.hpp"

namespace stillmap {
namespace {

// Closes the loops between the key frames from `begin` on and those of `places`.
std::size_t close_loops(Session& session,
                        const PlaceIndex& places,
                        KeyframeId begin,
                        const SystemConfig& config) {
  const MeasurementModel measure = loop_measurement_model(config, session.map.level_scales());
  LoopDetector detector(config.loop, session.camera, measure, config.seed);
  std::vector<KeyframeId> newer;
  for (const auto& [id, keyframe] : session.map.keyframes()) {
    if (id >= begin) newer.push_back(id);
  }
  std::size_t closed = 0;
  for (const KeyframeId id : newer) {
    const std::optional<LoopMatch> found = detector.advance(session.map, places, id);
    if (!found) continue;
    if (!close_loop(session.map, session.loops, *found, session.camera, measure, config.loop)) {
      continue;
    }
    detector.clear();
    ++closed;
  }
  return closed;
}

// The objects of the second session follow those of the first: where the loops have moved them to,
// or not at all when its submap was not joined.
void place_objects(Session& both, const Session& first, const Session& second) {
  const std::uint32_t offset = first.map.parts().next_keyframe.value;
  const auto objects = both.objects.begin() + static_cast<std::ptrdiff_t>(first.objects.size());
  const SubmapId submap = main_submap(second);
  for (const auto& [id, keyframe] : second.map.keyframes()) {
    const KeyframeId here(id.value + offset);
    if (keyframe.submap != submap || !both.map.keyframes().contains(here)) continue;
    if (both.map.keyframe(here).submap != main_submap(first)) break;
    const Eigen::Isometry3d T = both.map.T_world_keyframe(here) * keyframe.T_world_camera.inverse();
    for (auto object = objects; object != both.objects.end(); ++object) *object = moved(*object, T);
    return;
  }
  both.objects.erase(objects, both.objects.end());
}

}  // namespace

void check_fits(const Session& session,
                const CameraModel& camera,
                const std::vector<float>& level_scales,
                const std::string& place) {
  const CameraModel& its = session.camera;
  if (!same_lens(its, camera)) {
    throw Error(
        "{} is of camera '{}' ({} x {} px, fx {:.2f}), not of '{}' ({} x {} px, fx {:.2f}): "
        "expected the same camera",
        place,
        its.name,
        its.width_px,
        its.height_px,
        its.fx,
        camera.name,
        camera.width_px,
        camera.height_px,
        camera.fx);
  }
  if (session.map.level_scales() != level_scales) {
    throw Error(
        "{} has {} pyramid levels, of other sizes than the {} here: expected the same "
        "tracking.levels and tracking.scale_factor",
        place,
        session.map.level_scales().size(),
        level_scales.size());
  }
}

std::optional<MergedSessions> merge_sessions(const Session& first,
                                             const Session& second,
                                             const std::string& second_name) {
  check_fits(second, first.camera, first.map.level_scales(), second_name);
  const SystemConfig config = settings_of(first, "the first session");
  MergedSessions merged{appended(first, second), 0};
  Map& map = merged.session.map;
  const KeyframeId begin = first.map.parts().next_keyframe;
  merged.loops = close_loops(merged.session, index_of(first.map), begin, config);
  if (merged.loops == 0) return std::nullopt;
  const SubmapId submap = map.keyframe(merged.session.loops.back().a).submap;
  apply_correction(map,
                   adjust_globally(submap_window(map, submap),
                                   first.camera,
                                   loop_measurement_model(config, map.level_scales()),
                                   config.loop.bundle));
  place_objects(merged.session, first, second);
  return merged;
}

}  // namespace stillmap
