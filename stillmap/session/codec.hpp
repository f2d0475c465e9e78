// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stillmap/session/bytes.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/slam/map/map_parts.hpp"

namespace stillmap {

// The parts of a session as bytes. encode() gives the content of a section; decode_*() reads it to
// its end and throws Error when it has another form. Meanings are checked elsewhere
// (session_parts.hpp).

/// A pose in the file: a rotation matrix and a translation.
inline constexpr std::size_t kPoseSize = 12 * sizeof(double);

/// The numbers of the map that belong to no list.
[[nodiscard]] ByteWriter encode_map_head(const MapParts& map);
[[nodiscard]] MapParts decode_map_head(ByteReader content);

[[nodiscard]] ByteWriter encode(const Keyframe& keyframe);
/// Rebuilds the grid of the features. The list of landmarks stays empty.
[[nodiscard]] Keyframe decode_keyframe(ByteReader content, const CameraModel& camera);

[[nodiscard]] ByteWriter encode(std::span<const Landmark> landmarks);
[[nodiscard]] std::vector<Landmark> decode_landmarks(ByteReader content);

using DroppedKeyframes = std::vector<std::pair<KeyframeId, Anchor>>;
[[nodiscard]] ByteWriter encode(const DroppedKeyframes& dropped);
[[nodiscard]] DroppedKeyframes decode_dropped(ByteReader content);

[[nodiscard]] ByteWriter encode(const CameraModel& camera);
[[nodiscard]] CameraModel decode_camera(ByteReader content);
/// The version of a file: the oldest one that can describe its camera's lens and its views.
[[nodiscard]] std::uint32_t version_for(const CameraModel& camera,
                                        std::span<const ViewRecord> views);

[[nodiscard]] ByteWriter encode_text(const std::string& text);
[[nodiscard]] std::string decode_text(ByteReader content);

[[nodiscard]] ByteWriter encode(const std::vector<LoopEdge>& loops);
[[nodiscard]] std::vector<LoopEdge> decode_loops(ByteReader content);

[[nodiscard]] ByteWriter encode(const FrameRecords& frames);
[[nodiscard]] FrameRecords decode_frames(ByteReader content);

[[nodiscard]] ByteWriter encode(const ViewRecord& record);
[[nodiscard]] ViewRecord decode_view(ByteReader content);

[[nodiscard]] ByteWriter encode(const std::vector<KnownObject>& objects);
[[nodiscard]] std::vector<KnownObject> decode_objects(ByteReader content);

// Shared by several sections.
void put(ByteWriter& out, const Stamp& stamp);
[[nodiscard]] Stamp take_stamp(ByteReader& in);
template <class AnyId>
[[nodiscard]] AnyId take_id(ByteReader& in) {
  return AnyId(in.number<std::uint32_t>());
}

}  // namespace stillmap
