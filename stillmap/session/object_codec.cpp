// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/codec.hpp"

namespace stillmap {
namespace {

// A track, the sizes of three lists and the other numbers.
constexpr std::size_t kLeastObject = 4 + 4 + 8 + 4 + 1 + 8 + 64 * 4 + 4;

KnownObject take_object(ByteReader& in) {
  KnownObject object;
  object.track = take_id<TrackId>(in);
  object.class_name = in.text();
  object.seen_s = in.number<double>();
  object.sightings = in.number<std::int32_t>();
  if (in.flag()) {
    const Eigen::Vector3d least = in.vector();
    const Eigen::Vector3d most = in.vector();
    object.extent = {least, most};
    if (object.extent.isEmpty()) throw Error("{}: invalid extent", in.place());
  }
  object.extent_area_m2 = in.number<double>();
  for (float& share : object.colors) share = in.number<float>();
  const std::size_t points = in.count(3 * sizeof(double));
  for (std::size_t i = 0; i < points; ++i) object.surface.push_back(in.vector());
  return object;
}

}  // namespace

ByteWriter encode(const std::vector<KnownObject>& objects) {
  ByteWriter out;
  out.count(objects.size());
  for (const KnownObject& object : objects) {
    out.number(object.track.value);
    out.text(object.class_name);
    out.number(object.seen_s);
    out.number(static_cast<std::int32_t>(object.sightings));
    out.flag(!object.extent.isEmpty());
    if (!object.extent.isEmpty()) {
      out.vector(object.extent.min());
      out.vector(object.extent.max());
    }
    out.number(object.extent_area_m2);
    for (const float share : object.colors) out.number(share);
    out.count(object.surface.size());
    for (const Eigen::Vector3d& p : object.surface) out.vector(p);
  }
  return out;
}

std::vector<KnownObject> decode_objects(ByteReader content) {
  std::vector<KnownObject> objects;
  const std::size_t size = content.count(kLeastObject);
  if (size == 0) throw Error("{}: invalid number of objects: 0", content.place());
  for (std::size_t i = 0; i < size; ++i) objects.push_back(take_object(content));
  content.finish();
  return objects;
}

}  // namespace stillmap
