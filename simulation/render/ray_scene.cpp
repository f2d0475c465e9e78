// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/ray_scene.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <embree3/rtcore.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Owners of Embree's reference-counted handles.
template <class Handle, void (*release)(Handle)>
class Owned {
 public:
  explicit Owned(Handle handle) : handle_(handle) { STILLMAP_CHECK(handle_ != nullptr); }
  ~Owned() {
    if (handle_ != nullptr) release(handle_);
  }
  Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  [[nodiscard]] Handle get() const { return handle_; }

 private:
  Handle handle_;
};
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Scene = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

// Embree keeps no copy of shared vertices and reads up to 16 bytes at each, so that one float must
// follow the last.
std::vector<float> packed(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> floats;
  floats.reserve(3 * points.size() + 1);
  for (const Eigen::Vector3f& p : points) floats.insert(floats.end(), {p.x(), p.y(), p.z()});
  floats.push_back(0.F);
  return floats;
}

void share_vertices(const Geometry& geometry, const std::vector<float>& vertices) {
  rtcSetSharedGeometryBuffer(geometry.get(),
                             RTC_BUFFER_TYPE_VERTEX,
                             0,
                             RTC_FORMAT_FLOAT3,
                             vertices.data(),
                             0,
                             3 * sizeof(float),
                             vertices.size() / 3);
}

void share_triangles(const Geometry& geometry, const std::vector<Mesh::Triangle>& triangles) {
  rtcSetSharedGeometryBuffer(geometry.get(),
                             RTC_BUFFER_TYPE_INDEX,
                             0,
                             RTC_FORMAT_UINT3,
                             triangles.data(),
                             0,
                             sizeof(Mesh::Triangle),
                             triangles.size());
}

// Linear interpolation from `open` to `close`, at a time between 0 and 1.
Eigen::Matrix4f between(const Eigen::Isometry3d& open, const Eigen::Isometry3d& close, float time) {
  return (1.F - time) * open.cast<float>().matrix() + time * close.cast<float>().matrix();
}

std::vector<float> between(const std::vector<float>& open,
                           const std::vector<float>& close,
                           float time) {
  std::vector<float> result(open.size());
  for (std::size_t i = 0; i < open.size(); ++i)
    result[i] = (1.F - time) * open[i] + time * close[i];
  return result;
}

bool same_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return a.matrix() == b.matrix();
}

}  // namespace

Exposure Exposure::still(const Eigen::Isometry3d& T_world_camera, WorldState state) {
  return {{T_world_camera, T_world_camera, T_world_camera}, state, state};
}

// One scene for all immovable surfaces, in world axes, and one for each movable thing.
struct WorldGeometry::Parts {
  std::shared_ptr<const World> world;
  Device device;
  std::vector<Mesh> fixed;  // surfaces in world axes; empty for movable things
  std::vector<std::vector<float>> vertices;
  Scene fixed_scene;
  std::vector<std::uint32_t> fixed_things;  // by geometry of fixed_scene
  std::vector<std::uint32_t> movable_things;
  std::vector<Scene> movable_scenes;

  explicit Parts(std::shared_ptr<const World> shown);
  void attach(const Scene& scene, const std::vector<float>& points, const Mesh& mesh) const;
};

// One thread: the structure that Embree builds, and which of two surfaces in the same place a ray
// meets, must not depend on timing.
WorldGeometry::Parts::Parts(std::shared_ptr<const World> shown)
    : world(std::move(shown)),
      device(rtcNewDevice("threads=1,set_affinity=0")),
      fixed_scene(rtcNewScene(device.get())) {
  const std::vector<Thing>& things = world->things;
  rtcSetSceneBuildQuality(fixed_scene.get(), RTC_BUILD_QUALITY_HIGH);  // built once
  fixed.resize(things.size());
  vertices.resize(things.size());
  for (std::uint32_t i = 0; i < things.size(); ++i) {
    const Thing& thing = things[i];
    if (thing.mesh.triangles.empty()) continue;
    if (thing.id == 0) {
      fixed[i].append(thing.mesh, thing.T_world_thing);
      vertices[i] = packed(fixed[i].positions);
      attach(fixed_scene, vertices[i], fixed[i]);
      fixed_things.push_back(i);
    } else {
      vertices[i] = packed(thing.mesh.positions);
      movable_scenes.emplace_back(rtcNewScene(device.get()));
      attach(movable_scenes.back(), vertices[i], thing.mesh);
      rtcCommitScene(movable_scenes.back().get());
      movable_things.push_back(i);
    }
  }
  rtcCommitScene(fixed_scene.get());
}

void WorldGeometry::Parts::attach(const Scene& scene,
                                  const std::vector<float>& points,
                                  const Mesh& mesh) const {
  const Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  share_vertices(geometry, points);
  share_triangles(geometry, mesh.triangles);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
}

WorldGeometry::WorldGeometry(std::shared_ptr<const World> world)
    : parts_(std::make_unique<const Parts>(std::move(world))) {}
WorldGeometry::~WorldGeometry() = default;

const World& WorldGeometry::world() const {
  return *parts_->world;
}

// Geometry 0 is the immovable scene; the movable things follow, then the people.
struct RayScene::Parts {
  struct PersonSurface {
    PosedSurface open, close;
    bool moves = false;
  };
  // The world at one moment. One scene per moment is cheaper than one with moving geometry.
  struct Instant {
    Scene scene;
    std::vector<std::vector<float>> people;  // vertices
  };

  const WorldGeometry::Parts* geometry;
  Exposure exposure;
  std::vector<PersonSurface> people;
  std::vector<Instant> instants;  // by moment; a single one where nothing moves

  Parts(const WorldGeometry::Parts& shown, const Exposure& during);
  [[nodiscard]] Instant instant_at(float time) const;
  void add_instance(const Instant& instant, const Scene& part, const Eigen::Matrix4f& T) const;
  void add_person(const Instant& instant,
                  const std::vector<float>& vertices,
                  const Mesh& mesh) const;
  [[nodiscard]] bool moves() const;
  [[nodiscard]] std::uint32_t object_of(unsigned instance, unsigned part) const;
};

RayScene::Parts::Parts(const WorldGeometry::Parts& shown, const Exposure& during)
    : geometry(&shown), exposure(during) {
  const World& world = *shown.world;
  STILLMAP_CHECK(during.open.T_world_things.size() == world.things.size() &&
                 during.close.T_world_things.size() == world.things.size() &&
                 during.open.people.size() == world.people.size() &&
                 during.close.people.size() == world.people.size());
  for (std::size_t i = 0; i < world.people.size(); ++i) {
    const Body& body = world.people[i].body;
    PersonSurface surface{body.posed(during.open.people[i]), body.posed(during.close.people[i])};
    surface.moves = surface.open.positions != surface.close.positions;
    people.push_back(std::move(surface));
  }
  for (const float time : kMoments) {
    instants.push_back(instant_at(time));
    if (!moves()) break;
  }
}

bool RayScene::Parts::moves() const {
  for (const std::uint32_t thing : geometry->movable_things) {
    if (!same_pose(exposure.open.T_world_things[thing], exposure.close.T_world_things[thing])) {
      return true;
    }
  }
  return std::ranges::any_of(people, [](const PersonSurface& person) { return person.moves; });
}

RayScene::Parts::Instant RayScene::Parts::instant_at(float time) const {
  Instant instant{Scene(rtcNewScene(geometry->device.get())), {}};
  rtcSetSceneBuildQuality(instant.scene.get(), RTC_BUILD_QUALITY_LOW);  // built for every frame
  add_instance(instant, geometry->fixed_scene, Eigen::Matrix4f::Identity());
  for (std::size_t i = 0; i < geometry->movable_things.size(); ++i) {
    const std::uint32_t thing = geometry->movable_things[i];
    add_instance(
        instant,
        geometry->movable_scenes[i],
        between(exposure.open.T_world_things[thing], exposure.close.T_world_things[thing], time));
  }
  instant.people.reserve(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    instant.people.push_back(
        between(packed(people[i].open.positions), packed(people[i].close.positions), time));
    add_person(instant, instant.people.back(), geometry->world->people[i].body.rest());
  }
  rtcCommitScene(instant.scene.get());
  return instant;
}

void RayScene::Parts::add_instance(const Instant& instant,
                                   const Scene& part,
                                   const Eigen::Matrix4f& T) const {
  const Geometry instance(rtcNewGeometry(geometry->device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.get(), part.get());
  rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, T.data());
  rtcCommitGeometry(instance.get());
  rtcAttachGeometry(instant.scene.get(), instance.get());
}

void RayScene::Parts::add_person(const Instant& instant,
                                 const std::vector<float>& vertices,
                                 const Mesh& mesh) const {
  const Geometry person(rtcNewGeometry(geometry->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  rtcSetGeometryBuildQuality(person.get(), RTC_BUILD_QUALITY_LOW);
  share_vertices(person, vertices);
  share_triangles(person, mesh.triangles);
  rtcCommitGeometry(person.get());
  rtcAttachGeometry(instant.scene.get(), person.get());
}

std::uint32_t RayScene::Parts::object_of(unsigned instance, unsigned part) const {
  if (instance == 0) return geometry->fixed_things[part];
  if (instance != RTC_INVALID_GEOMETRY_ID) return geometry->movable_things[instance - 1];
  const std::size_t person = part - 1 - geometry->movable_things.size();
  return static_cast<std::uint32_t>(geometry->world->things.size() + person);
}

RayScene::RayScene(const WorldGeometry& geometry, const Exposure& exposure)
    : parts_(std::make_unique<const Parts>(*geometry.parts_, exposure)) {}
RayScene::~RayScene() = default;

namespace {

constexpr float kNearest = 1e-4F;  // in lengths of the direction

template <class Rays>
void set_ray(Rays& packet, std::size_t i, const Ray& ray) {
  packet.org_x[i] = ray.origin.x();
  packet.org_y[i] = ray.origin.y();
  packet.org_z[i] = ray.origin.z();
  packet.dir_x[i] = ray.direction.x();
  packet.dir_y[i] = ray.direction.y();
  packet.dir_z[i] = ray.direction.z();
  packet.tnear[i] = kNearest;
  packet.tfar[i] = ray.reach;
  packet.time[i] = 0.F;
  packet.mask[i] = 0xffffffffU;
  packet.flags[i] = 0;
}

using Lanes = std::array<int, kRays>;

Lanes used_lanes(std::size_t count) {
  STILLMAP_CHECK(count <= kRays);
  Lanes valid{};
  for (std::size_t i = 0; i < count; ++i) valid[i] = -1;
  return valid;
}

}  // namespace

std::array<SurfaceHit, kRays> RayScene::first_hits(std::span<const Ray> rays,
                                                   std::size_t moment) const {
  const std::size_t last = parts_->instants.size() - 1;
  const Parts::Instant& instant = parts_->instants[std::min(moment, last)];
  alignas(32) const Lanes valid = used_lanes(rays.size());
  RTCRayHit8 packet;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    set_ray(packet.ray, i, rays[i]);
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid.data(), instant.scene.get(), &context, &packet);
  std::array<SurfaceHit, kRays> hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = {parts_->object_of(packet.hit.instID[0][i], packet.hit.geomID[i]),
               packet.hit.primID[i],
               packet.ray.tfar[i]};
  }
  return hits;
}

std::uint32_t RayScene::blocked(std::span<const Ray> rays) const {
  alignas(32) const Lanes valid = used_lanes(rays.size());
  RTCRay8 packet;
  for (std::size_t i = 0; i < rays.size(); ++i) set_ray(packet, i, rays[i]);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid.data(), parts_->instants[kMiddle].scene.get(), &context, &packet);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (packet.tfar[i] < 0.F) bits |= 1U << i;
  }
  return bits;
}

SurfaceTriangle RayScene::triangle(const SurfaceHit& hit) const {
  const World& world = *parts_->geometry->world;
  const bool person = hit.object >= world.things.size();
  const std::size_t index = person ? hit.object - world.things.size() : hit.object;
  const Mesh& mesh = person                        ? world.people[index].body.rest()
                     : world.things[index].id != 0 ? world.things[index].mesh
                                                   : parts_->geometry->fixed[index];
  const Mesh::Triangle& corners = mesh.triangles[hit.triangle];
  SurfaceTriangle result;
  result.material = mesh.materials[hit.triangle];
  for (std::size_t k = 0; k < 3; ++k) result.uvs[k] = mesh.uvs[corners[k]];
  if (person) {
    const Parts::PersonSurface& surface = parts_->people[index];
    result.moves = surface.moves;
    for (std::size_t k = 0; k < 3; ++k) {
      result.open[k] = surface.open.positions[corners[k]];
      result.close[k] = surface.close.positions[corners[k]];
      result.normals[k] = surface.open.normals[corners[k]];
    }
    return result;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    result.open[k] = mesh.positions[corners[k]];
    result.normals[k] = mesh.normals[corners[k]];
  }
  if (world.things[index].id == 0) {
    result.close = result.open;
    return result;
  }
  const Eigen::Isometry3f open = parts_->exposure.open.T_world_things[index].cast<float>();
  const Eigen::Isometry3f close = parts_->exposure.close.T_world_things[index].cast<float>();
  result.moves = !(open.matrix() == close.matrix());
  for (std::size_t k = 0; k < 3; ++k) {
    result.close[k] = close * result.open[k];
    result.open[k] = open * result.open[k];
    result.normals[k] = open.linear() * result.normals[k];
  }
  return result;
}

std::uint8_t RayScene::mask_id(std::uint32_t object) const {
  const World& world = *parts_->geometry->world;
  const std::size_t things = world.things.size();
  return object < things ? world.things[object].id : world.people[object - things].id;
}

}  // namespace stillmap
