// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/body.hpp"
#include "simulation/scene/material.hpp"
#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// A rigid object. World axes: z up, the floor at z = 0.
struct Thing {
  std::string name;        ///< unique in its world: "chair_1", "desk_2"
  std::string class_name;  ///< the COCO name if there is one, else a plain word: "box", "wall"
  std::uint8_t id = 0;     ///< in masks: 10 to 99 for movable things, 0 for others
  Mesh mesh;               ///< in the thing's own frame
  Eigen::Isometry3d T_world_thing = Eigen::Isometry3d::Identity();  ///< initial pose
};

/// A person.
struct Person {
  std::string name;     ///< "person_1"
  std::uint8_t id = 0;  ///< in masks: 1 to 9
  Body body;
};

/// A rectangle in the ceiling that gives light; it casts soft shadows.
struct AreaLamp {
  Eigen::Vector3d center_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_u_world = Eigen::Vector3d::Zero();  ///< from the centre to one side
  Eigen::Vector3d half_v_world = Eigen::Vector3d::Zero();
  double power = 1.0;  ///< light on a surface that faces it from 1 m away
};

/// The scene: everything that is visible.
struct World {
  MaterialLibrary materials;
  std::vector<Thing> things;
  std::vector<Person> people;
  std::vector<AreaLamp> lamps;
  double ambient = 0.35;  ///< light that comes from everywhere
};

/// The poses of everything at one time.
struct WorldState {
  std::vector<Eigen::Isometry3d> T_world_things;  ///< of all World::things
  std::vector<BodyPose> people;                   ///< of World::people
};

}  // namespace stillmap
