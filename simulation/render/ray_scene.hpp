// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/world.hpp"

namespace stillmap {

/// The poses of a camera while the shutter is open. Motion is linear from `open` to `close`.
struct CameraExposure {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< half way
  Eigen::Isometry3d T_world_camera_open = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_camera_close = Eigen::Isometry3d::Identity();
};

/// The poses of everything while the shutter is open.
struct Exposure : CameraExposure {
  WorldState open = {};
  WorldState close = {};
  /// The camera while each row is exposed: a rolling shutter. Empty: all rows together. The world
  /// is that of the whole exposure in every row.
  std::vector<CameraExposure> rows = {};

  /// The camera while row `y` is exposed.
  [[nodiscard]] const CameraExposure& of_row(int y) const {
    return rows.empty() ? *this : rows[static_cast<std::size_t>(y)];
  }

  /// An exposure without motion.
  [[nodiscard]] static Exposure still(const Eigen::Isometry3d& T_world_camera, WorldState state);
};

/// The times within an exposure at which rays are traced, from 0 to 1: first the middle, then the
/// middles of both halves.
inline constexpr std::array<float, 3> kMoments{0.5F, 0.25F, 0.75F};
inline constexpr std::size_t kMiddle = 0;
/// The index of the moment of each quarter of a pixel, row by row: the upper quarters before the
/// lower.
inline constexpr std::array<std::size_t, 4> kQuarterMoments{1, 1, 2, 2};

/// A ray in world coordinates.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< of any length
  float reach = 1e9F;                                   ///< in lengths of `direction`
};

/// The first surface on a ray.
struct SurfaceHit {
  static constexpr std::uint32_t kNothing = 0xffffffffU;
  std::uint32_t object = kNothing;  ///< things first, then people, as in their World
  std::uint32_t triangle = 0;
  float t = 0.F;  ///< the point is origin + t * direction

  [[nodiscard]] bool valid() const { return object != kNothing; }
};

/// A triangle of a surface in world coordinates.
struct SurfaceTriangle {
  std::array<Eigen::Vector3f, 3> open;   ///< corners when the shutter opens
  std::array<Eigen::Vector3f, 3> close;  ///< corners when the shutter closes
  std::array<Eigen::Vector3f, 3> normals;
  std::array<Eigen::Vector2f, 3> uvs;
  MaterialId material = 0;
  bool moves = false;  ///< whether `open` and `close` differ
};

/// The number of rays that are traced at once.
inline constexpr std::size_t kRays = 8;

/// The surfaces of a world, prepared once for tracing. Safe to use from several threads.
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

/// A world during one exposure. Safe to use from several threads.
class RayScene {
 public:
  /// `geometry` must outlive the scene. `exposure` has states of the world of `geometry`.
  RayScene(const WorldGeometry& geometry, const Exposure& exposure);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// The first hits of the rays at kMoments[moment]. At most kRays rays, which should be close
  /// together.
  [[nodiscard]] std::array<SurfaceHit, kRays> first_hits(std::span<const Ray> rays,
                                                         std::size_t moment = kMiddle) const;

  /// Bit i is set if ray i is blocked within its reach in the middle of the exposure. At most kRays
  /// rays.
  [[nodiscard]] std::uint32_t blocked(std::span<const Ray> rays) const;

  [[nodiscard]] SurfaceTriangle triangle(const SurfaceHit& hit) const;

  /// The mask id of the object that was hit.
  [[nodiscard]] std::uint8_t mask_id(std::uint32_t object) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace stillmap
