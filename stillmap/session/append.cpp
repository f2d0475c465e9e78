// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/append.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct Offsets {
  std::uint32_t keyframe, landmark, submap, frame;
};

std::uint32_t end_of(std::span<const SubmapId> submaps) {
  return submaps.empty() ? 0 : submaps.back().value + 1;
}

// For numbers of at most kMaxId.
void check_sum(std::uint32_t a, std::uint32_t b) {
  if (b <= kMaxId - a) return;
  throw Error("these sessions together have more key frames, landmarks or frames than fit ({})",
              kMaxId);
}

template <class Tag>
Id<Tag> shifted(Id<Tag> id, std::uint32_t offset) {
  return id.valid() ? Id<Tag>(id.value + offset) : id;
}

Keyframe shifted(Keyframe keyframe, const Offsets& by) {
  keyframe.id = shifted(keyframe.id, by.keyframe);
  keyframe.submap = shifted(keyframe.submap, by.submap);
  for (LandmarkId& id : keyframe.landmarks) id = shifted(id, by.landmark);
  return keyframe;
}

Landmark shifted(Landmark landmark, const Offsets& by) {
  landmark.id = shifted(landmark.id, by.landmark);
  landmark.created_by = shifted(landmark.created_by, by.keyframe);
  for (Observation& o : landmark.observations) o.keyframe = shifted(o.keyframe, by.keyframe);
  return landmark;
}

MapParts appended(MapParts parts, const MapParts& second, const Offsets& by) {
  for (const Keyframe& keyframe : second.keyframes) {
    parts.keyframes.push_back(shifted(keyframe, by));
  }
  for (const Landmark& landmark : second.landmarks) {
    parts.landmarks.push_back(shifted(landmark, by));
  }
  for (const auto& [id, anchor] : second.dropped_keyframes) {
    parts.dropped_keyframes.emplace_back(
        shifted(id, by.keyframe),
        Anchor{shifted(anchor.keyframe, by.keyframe), anchor.T_anchor_dropped});
  }
  parts.next_keyframe = shifted(second.next_keyframe, by.keyframe);
  parts.next_landmark = shifted(second.next_landmark, by.landmark);
  return parts;
}

}  // namespace

Session appended(const Session& first, const Session& second) {
  const MapParts parts = first.map.parts(), others = second.map.parts();
  const Offsets by{parts.next_keyframe.value,
                   parts.next_landmark.value,
                   end_of(first.map.submaps()),
                   static_cast<std::uint32_t>(first.frames.size())};
  check_sum(by.keyframe, others.next_keyframe.value);
  check_sum(by.landmark, others.next_landmark.value);
  check_sum(by.submap, end_of(second.map.submaps()));
  check_sum(by.frame, static_cast<std::uint32_t>(second.frames.size()));
  Session both = first;
  both.map = Map::from_parts(appended(parts, others, by), "the sessions together");
  for (LoopEdge loop : second.loops) {
    loop.a = shifted(loop.a, by.keyframe);
    loop.b = shifted(loop.b, by.keyframe);
    both.loops.push_back(loop);
  }
  for (FrameRecord frame : second.frames) {
    frame.reference = shifted(frame.reference, by.keyframe);
    both.frames.push_back(std::move(frame));
  }
  for (const ViewRecord& view : second.views) {
    both.views.push_back({view.frame + by.frame, view.view, view.depth_after_color_s});
  }
  const std::uint32_t tracks = both.objects.empty() ? 0 : both.objects.back().track.value + 1;
  if (!second.objects.empty()) check_sum(tracks, second.objects.back().track.value);
  for (KnownObject object : second.objects) {
    object.track = shifted(object.track, tracks);
    both.objects.push_back(std::move(object));
  }
  return both;
}

}  // namespace stillmap
