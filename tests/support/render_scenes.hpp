// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <random>

#include "simulation/render/ray_scene.hpp"
#include "stillmap/geometry/camera.hpp"
#include "tests/support/cameras.hpp"

namespace stillmap {

inline CameraModel small_camera(int width_px = 96, int height_px = 72) {
  return centered_camera(width_px, height_px, 0.9 * width_px);
}

/// A camera that looks along +x, the world's z axis being up in its image.
inline Eigen::Isometry3d looking_along_x(const Eigen::Vector3d& position) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.translation() = position;
  return T;
}

/// A rectangle in the plane x = `x`, seen from -x, with its picture upright.
inline Mesh wall(double x, double half_width, double half_height, MaterialId material) {
  const float w = static_cast<float>(half_width), h = static_cast<float>(half_height);
  const float depth = static_cast<float>(x);
  Mesh mesh;
  mesh.positions = {{depth, w, h}, {depth, -w, h}, {depth, -w, -h}, {depth, w, -h}};
  mesh.normals.assign(4, -Eigen::Vector3f::UnitX());
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  mesh.materials.assign(2, material);
  return mesh;
}

inline WorldState rest_state(const World& world) {
  WorldState state;
  for (const Thing& thing : world.things) state.T_world_things.push_back(thing.T_world_thing);
  for (const Person& person : world.people) {
    (void)person;
    state.people.emplace_back();
  }
  return state;
}

/// Random triangles before a camera at the origin that looks along +x, in a few things, some with
/// an id.
inline World random_world(unsigned seed) {
  World world;
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  const MaterialId gray = world.materials.add_plain({128, 128, 128});
  for (unsigned k = 0; k < 4; ++k) {
    Thing thing;
    thing.name = "thing_" + std::to_string(k);
    thing.id = static_cast<std::uint8_t>(k < 2 ? 0 : 9 + k);
    thing.T_world_thing.translation() = Eigen::Vector3d(3.0, 0.3 * k, -0.2 * k);
    thing.T_world_thing.rotate(Eigen::AngleAxisd(0.5 * k, Eigen::Vector3d::UnitY()));
    for (unsigned i = 0; i < 30; ++i) {
      const Eigen::Vector3f center(uniform(rng), 1.5F * uniform(rng), 1.5F * uniform(rng));
      for (int c = 0; c < 3; ++c) {
        thing.mesh.positions.push_back(
            center + 0.3F * Eigen::Vector3f(uniform(rng), uniform(rng), uniform(rng)));
      }
      thing.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      thing.mesh.materials.push_back(gray);
    }
    thing.mesh.normals.assign(thing.mesh.positions.size(), Eigen::Vector3f::UnitZ());
    thing.mesh.uvs.assign(thing.mesh.positions.size(), Eigen::Vector2f::Zero());
    world.things.push_back(std::move(thing));
  }
  return world;
}

}  // namespace stillmap
