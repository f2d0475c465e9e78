// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_log_codec.hpp"

#include <cstdint>
#include <optional>

#include "stillmap/session/bytes.hpp"

namespace stillmap {
namespace {

// A place for messages; nobody but this program has written the bytes.
constexpr const char* kPlace = "the log of objects";

template <class Value>
void put_enum(ByteWriter& out, Value value) {
  out.number(static_cast<std::uint8_t>(value));
}

template <class Value>
Value take_enum(ByteReader& in) {
  return static_cast<Value>(in.number<std::uint8_t>());
}

void put_track(ByteWriter& out, const std::optional<TrackId>& track) {
  out.flag(track.has_value());
  if (track) out.number(track->value);
}

std::optional<TrackId> take_track(ByteReader& in) {
  if (!in.flag()) return std::nullopt;
  return TrackId(in.number<std::uint32_t>());
}

void put(ByteWriter& out, const ObjectState& object) {
  out.number(object.track.value);
  out.text(object.class_name);
  put_enum(out, object.category);
  out.flag(object.dynamic);
  put_enum(out, object.reason);
  put_track(out, object.person);
  for (const double edge : {object.box.x0, object.box.y0, object.box.x1, object.box.y1}) {
    out.number(edge);
  }
  out.flag(object.filled);
  const Motion& motion = object.motion;
  put_enum(out, motion.state);
  out.flag(motion.p_world.has_value());
  if (motion.p_world) out.vector(*motion.p_world);
  out.vector(motion.velocity_m_s);
  put_track(out, motion.by);
}

ObjectState take_object(ByteReader& in) {
  ObjectState object;
  object.track = TrackId(in.number<std::uint32_t>());
  object.class_name = in.text();
  object.category = take_enum<Category>(in);
  object.dynamic = in.flag();
  object.reason = take_enum<StateReason>(in);
  object.person = take_track(in);
  for (double* const edge : {&object.box.x0, &object.box.y0, &object.box.x1, &object.box.y1}) {
    *edge = in.number<double>();
  }
  object.filled = in.flag();
  Motion& motion = object.motion;
  motion.state = take_enum<MotionState>(in);
  if (in.flag()) motion.p_world = in.vector();
  motion.velocity_m_s = in.vector();
  motion.by = take_track(in);
  return object;
}

}  // namespace

std::string encode(const LoggedFrame& frame) {
  const auto& [pose, objects] = frame;
  ByteWriter out;
  out.number(pose.stamp.seconds);
  out.text(pose.stamp.text);
  out.pose(pose.T_world_camera);
  out.count(objects.size());
  for (const ObjectState& object : objects) put(out, object);
  return out.bytes();
}

LoggedFrame decode_logged_frame(std::string_view bytes) {
  ByteReader in(std::string(bytes), kPlace);
  LoggedFrame frame;
  auto& [pose, objects] = frame;
  pose.stamp.seconds = in.number<double>();
  pose.stamp.text = in.text();
  pose.T_world_camera = in.pose();
  const std::size_t count = in.count(1);
  for (std::size_t i = 0; i < count; ++i) objects.push_back(take_object(in));
  in.finish();
  return frame;
}

}  // namespace stillmap
