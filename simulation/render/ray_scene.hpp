// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include <Eigen/Geometry>

#include "simulation/scene/world.hpp"

namespace stillmap {

/// Where everything is while the shutter is open; what moves goes straight from one to the other.
struct Exposure {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< half way
  Eigen::Isometry3d T_world_camera_open = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_camera_close = Eigen::Isometry3d::Identity();
  WorldState open;
  WorldState close;

  /// Without motion: everything stands still while the shutter is open.
  [[nodiscard]] static Exposure still(const Eigen::Isometry3d& T_world_camera, WorldState state);
};

/// The times within an exposure at which rays are traced, 0 its beginning and 1 its end: first its
/// middle, then the middles of its halves.
inline constexpr std::array<float, 3> kMoments{0.5F, 0.25F, 0.75F};
inline constexpr std::size_t kMiddle = 0;
/// At which of them each quarter of a pixel is taken, in rows: the upper ones before the lower.
inline constexpr std::array<std::size_t, 4> kQuarterMoments{1, 1, 2, 2};

/// A ray in world axes.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< of any length
  float reach = 1e9F;                                   ///< in lengths of `direction`
};

/// The surface that a ray meets.
struct SurfaceHit {
  static constexpr std::uint32_t kNothing = 0xffffffffU;
  std::uint32_t object = kNothing;  ///< things first, then people, as in their World
  std::uint32_t triangle = 0;
  float t = 0.F;  ///< the point is origin + t * direction

  [[nodiscard]] bool valid() const { return object != kNothing; }
};

/// A triangle of a surface in world axes.
struct SurfaceTriangle {
  std::array<Eigen::Vector3f, 3> open;   ///< corners when the shutter opens
  std::array<Eigen::Vector3f, 3> close;  ///< and when it closes
  std::array<Eigen::Vector3f, 3> normals;
  std::array<Eigen::Vector2f, 3> uvs;
  MaterialId material = 0;
  bool moves = false;  ///< whether `open` and `close` differ
};

/// How many rays are traced at once.
inline constexpr std::size_t kRays = 8;

/// A world's surfaces, arranged for rays once. May serve several threads.
class WorldGeometry {
 public:
  explicit WorldGeometry(std::shared_ptr<const World> world);
  ~WorldGeometry();
  WorldGeometry(const WorldGeometry&) = delete;
  WorldGeometry& operator=(const WorldGeometry&) = delete;

  [[nodiscard]] const World& world() const;

 private:
  friend class RayScene;
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// A world during one exposure. May serve several threads.
class RayScene {
 public:
  /// `geometry` must outlive this. `exposure` has the states of its world.
  RayScene(const WorldGeometry& geometry, const Exposure& exposure);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// What the rays meet first at kMoments[moment]; at most kRays of them, which should lie close
  /// together.
  [[nodiscard]] std::array<SurfaceHit, kRays> first_hits(std::span<const Ray> rays,
                                                         std::size_t moment = kMiddle) const;

  /// Bit i says whether something lies on ray i within its reach, in the exposure's middle; at most
  /// kRays of them.
  [[nodiscard]] std::uint32_t blocked(std::span<const Ray> rays) const;

  [[nodiscard]] SurfaceTriangle triangle(const SurfaceHit& hit) const;

  /// The mask id of what was hit.
  [[nodiscard]] std::uint8_t mask_id(std::uint32_t object) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace stillmap
