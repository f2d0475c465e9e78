// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/scene/texture.hpp"

namespace stillmap {

/// A box whose faces carry textures. Face 2 * axis is the one at -half_size[axis], face
/// 2 * axis + 1 the one at +half_size[axis].
struct SceneBox {
  Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();  ///< metres
  std::array<std::size_t, 6> textures{};                ///< index into Scene::textures, by face
  bool seen_from_inside = false;                        ///< a room: the camera is in it
};

/// A static world of textured boxes under one lamp. World axes: z up, the floor at z = 0.
struct Scene {
  std::vector<SceneBox> boxes;
  std::vector<MipTexture> textures;
  Eigen::Vector3d lamp_world = Eigen::Vector3d::Zero();
  double ambient = 0.5;  ///< share of the light that comes from everywhere; the rest from the lamp
};

/// Where a ray meets a scene.
struct SceneHit {
  std::size_t box = 0;
  int face = 0;
  double t = 0;  ///< the point is origin + t * direction
};

/// The axes of a face's plane that its picture's columns and rows run along.
struct FaceAxes {
  int normal;
  int column;
  int row;
};
[[nodiscard]] constexpr FaceAxes face_axes(int face) {
  constexpr std::array<FaceAxes, 3> kAxes{{{0, 1, 2}, {1, 0, 2}, {2, 0, 1}}};
  return kAxes[static_cast<std::size_t>(face / 2)];
}

/// The first surface that a ray from `origin` meets at t > 0, tried against every box.
[[nodiscard]] std::optional<SceneHit> first_hit(const Scene& scene,
                                                const Eigen::Vector3d& origin_world,
                                                const Eigen::Vector3d& direction_world);

/// A furnished room of 6 x 6 x 2.7 m, centred on the world's z axis: walls with posters and blank
/// stretches, three desks with things on them, a shelf with books, cartons. Its layout is fixed;
/// `seed` varies what is painted on it.
[[nodiscard]] Scene make_room(std::uint32_t seed);

}  // namespace stillmap
