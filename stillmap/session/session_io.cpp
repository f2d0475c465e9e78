// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_io.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/input_file.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/codec.hpp"
#include "stillmap/session/sections.hpp"
#include "stillmap/session/session_parts.hpp"

namespace stillmap {
namespace {

// The tags of the sections, in order.
constexpr std::string_view kCamera = "CAMR";
constexpr std::string_view kConfig = "CONF";
constexpr std::string_view kMapHead = "MAPH";
constexpr std::string_view kKeyframe = "KEYF";   // one section each
constexpr std::string_view kLandmarks = "LMRK";  // kLandmarksTogether in each but the last
constexpr std::string_view kDropped = "DROP";
constexpr std::string_view kLoops = "LOOP";
constexpr std::string_view kFrames = "FRAM";
constexpr std::string_view kView = "VIEW";     // one section each
constexpr std::string_view kObjects = "OBJS";  // none without objects

constexpr std::size_t kLandmarksTogether = 65536;

// The feature grid of a large image has many cells even for few features. The limit keeps memory in
// proportion to the file.
void check_grid_memory(const CameraModel& camera,
                       std::size_t keyframes,
                       std::size_t bytes,
                       const std::string& place) {
  const std::size_t cells = (static_cast<std::size_t>(camera.width_px) / 16 + 1) *
                            (static_cast<std::size_t>(camera.height_px) / 16 + 1);
  if (keyframes * cells > (std::size_t{1} << 26U) + 16 * bytes) {
    throw Error("{}: invalid key frames: hardly any features in images of {} x {}",
                place,
                camera.width_px,
                camera.height_px);
  }
}

void write_keyframes(SectionWriter& out, const SessionParts& parts, const std::string& place) {
  std::size_t keyframes = 0, bytes = 0;
  for (const Keyframe& keyframe : parts.map.keyframes) {
    const ByteWriter content = encode(keyframe);
    bytes += content.bytes().size();
    check_grid_memory(parts.camera, ++keyframes, bytes, place);
    out.write(kKeyframe, content, place);
  }
}

// Messages begin with `place`.
void write_parts(const SessionParts& parts,
                 const SectionWriter::Sink& sink,
                 const std::string& place) {
  check_parts(parts.map, place);
  check_records(parts, place);
  SectionWriter out(sink, version_for(parts.camera, parts.views));
  out.write(kCamera, encode(parts.camera), place);
  out.write(kConfig, encode_text(parts.config_yaml), place);
  out.write(kMapHead, encode_map_head(parts.map), place);
  write_keyframes(out, parts, place);
  std::span<const Landmark> landmarks = parts.map.landmarks;
  while (!landmarks.empty()) {
    const std::size_t size = std::min(kLandmarksTogether, landmarks.size());
    out.write(kLandmarks, encode(landmarks.first(size)), place);
    landmarks = landmarks.subspan(size);
  }
  out.write(kDropped, encode(parts.map.dropped_keyframes), place);
  out.write(kLoops, encode(parts.loops), place);
  out.write(kFrames, encode(parts.frames), place);
  for (const ViewRecord& view : parts.views) out.write(kView, encode(view), place);
  if (!parts.objects.empty()) out.write(kObjects, encode(parts.objects), place);
  out.finish();
}

std::vector<Keyframe> read_keyframes(SectionReader& in, const CameraModel& camera) {
  std::vector<Keyframe> keyframes;
  std::size_t bytes = 0;
  while (in.at(kKeyframe)) {
    ByteReader content = in.read(kKeyframe);
    bytes += content.size();
    check_grid_memory(camera, keyframes.size() + 1, bytes, in.file());
    keyframes.push_back(decode_keyframe(std::move(content), camera));
  }
  return keyframes;
}

std::vector<Landmark> read_landmarks(SectionReader& in) {
  std::vector<Landmark> landmarks;
  while (in.at(kLandmarks)) {
    if (landmarks.size() % kLandmarksTogether != 0) {
      throw Error("{}: invalid landmarks: not {} in a part", in.file(), kLandmarksTogether);
    }
    std::vector<Landmark> some = decode_landmarks(in.read(kLandmarks));
    if (some.empty() || some.size() > kLandmarksTogether) {
      throw Error("{}: invalid landmarks: {} in a part", in.file(), some.size());
    }
    std::ranges::move(some, std::back_inserter(landmarks));
  }
  return landmarks;
}

std::vector<ViewRecord> read_views(SectionReader& in, const SessionReadOptions& options) {
  std::vector<ViewRecord> views;
  while (in.at(kView)) {
    if (options.with_views) {
      views.push_back(decode_view(in.read(kView)));
    } else {
      in.skip(kView);
    }
  }
  return views;
}

Session read(SectionReader in, const SessionReadOptions& options) {
  SessionParts parts;
  parts.camera = decode_camera(in.read(kCamera));
  check_camera(parts.camera, in.file());
  parts.config_yaml = decode_text(in.read(kConfig));
  parts.map = decode_map_head(in.read(kMapHead));
  parts.map.keyframes = read_keyframes(in, parts.camera);
  parts.map.landmarks = read_landmarks(in);
  parts.map.dropped_keyframes = decode_dropped(in.read(kDropped));
  parts.loops = decode_loops(in.read(kLoops));
  parts.frames = decode_frames(in.read(kFrames));
  parts.views = read_views(in, options);
  if (in.at(kObjects)) parts.objects = decode_objects(in.read(kObjects));
  in.finish();
  check_records(parts, in.file());
  return {std::move(parts.camera),
          std::move(parts.config_yaml),
          Map::from_parts(std::move(parts.map), in.file()),
          std::move(parts.loops),
          std::move(parts.frames),
          std::move(parts.views),
          std::move(parts.objects)};
}

}  // namespace

void write_session(const std::filesystem::path& path, const Session& session) {
  AtomicFile file(path);
  write_session(
      [&](std::string_view bytes) { file.write(bytes); }, session, "cannot write " + path.string());
  file.close();
  file.take_place();
}

void write_session(const std::function<void(std::string_view)>& sink,
                   const Session& session,
                   const std::string& place) {
  write_parts(parts_of(session), sink, place);
}

Session read_session(const std::filesystem::path& path, const SessionReadOptions& options) {
  const InputFile file(path);
  const ByteSource source{
      file.size(), [&](std::uint64_t offset, std::size_t size) { return file.read(offset, size); }};
  return read(SectionReader(source, path.string()), options);
}

std::string encode_session(const Session& session) {
  std::string bytes;
  write_parts(
      parts_of(session), [&](std::string_view more) { bytes.append(more); }, "the session");
  return bytes;
}

Session decode_session(std::string_view bytes,
                       const std::string& name,
                       const SessionReadOptions& options) {
  const ByteSource source{bytes.size(), [&](std::uint64_t offset, std::size_t size) {
                            return std::string(bytes.substr(offset, size));
                          }};
  return read(SectionReader(source, name), options);
}

}  // namespace stillmap
