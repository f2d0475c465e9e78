// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/office.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/scene/hash_random.hpp"
#include "simulation/scene/roles.hpp"

namespace stillmap {
namespace {

using Bounds = Eigen::AlignedBox3d;
using Eigen::Vector3d;

const World& office() {
  static const World world = make_office(1);
  return world;
}

Bounds bounds_of(const Thing& thing) {
  Bounds bounds;
  for (const Eigen::Vector3f& p : thing.mesh.positions) {
    bounds.extend(thing.T_world_thing * p.cast<double>());
  }
  return bounds;
}

bool is_shell(const Thing& thing) {
  return thing.class_name == "wall" || thing.class_name == "floor" || thing.class_name == "ceiling";
}

TEST(Office, StaysWithinItsRoom) {
  const Bounds room(Vector3d(-3, -3, 0), Vector3d(3, 3, 2.7));
  for (const Thing& thing : office().things) {
    const Bounds bounds = bounds_of(thing);
    const double slack = is_shell(thing) ? 0.11 : 1e-6;
    EXPECT_LE(room.exteriorDistance(bounds.min()), slack * std::sqrt(3.0)) << thing.name;
    EXPECT_LE(room.exteriorDistance(bounds.max()), slack * std::sqrt(3.0)) << thing.name;
  }
}

TEST(Office, MeshesAreSound) {
  std::size_t triangles = 0;
  for (const Thing& thing : office().things) {
    const Mesh& mesh = thing.mesh;
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << thing.name;
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size()) << thing.name;
    ASSERT_EQ(mesh.materials.size(), mesh.triangles.size()) << thing.name;
    for (const Eigen::Vector3f& n : mesh.normals) ASSERT_NEAR(n.norm(), 1.F, 1e-4F) << thing.name;
    for (const Eigen::Vector2f& uv : mesh.uvs) ASSERT_TRUE(uv.allFinite()) << thing.name;
    for (const MaterialId id : mesh.materials) ASSERT_LT(id, office().materials.size());
    for (const Mesh::Triangle& t : mesh.triangles) {
      for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.positions.size());
      const Vector3d a = mesh.positions[t[0]].cast<double>();
      const Vector3d ab = mesh.positions[t[1]].cast<double>() - a;
      const Vector3d ac = mesh.positions[t[2]].cast<double>() - a;
      ASSERT_GT(ab.cross(ac).norm(), 1e-10) << thing.name;
    }
    triangles += mesh.triangles.size();
  }
  EXPECT_GT(triangles, 30000U);
  EXPECT_LT(triangles, 120000U);
}

TEST(Office, OnlyWhatMayBeMovedHasAnId) {
  const std::map<std::string, int> expected{
      {"chair_1", 10}, {"chair_2", 11}, {"chair_3", 12}, {"box_1", 13}};
  std::set<std::string> names;
  for (const Thing& thing : office().things) {
    EXPECT_TRUE(names.insert(thing.name).second) << thing.name << " occurs twice";
    const auto movable = expected.find(thing.name);
    EXPECT_EQ(thing.id, movable == expected.end() ? 0 : movable->second) << thing.name;
  }
  for (const auto& [name, id] : expected) EXPECT_TRUE(names.contains(name)) << name;
}

// Positions of cameras: near the middle, on a half sphere, and on a circle.
std::vector<Vector3d> camera_places() {
  std::vector<Vector3d> places;
  for (int i = 0; i < 27; ++i) {
    places.emplace_back(
        -0.4 + 0.3 * (i % 3 - 1), 0.1 + 0.3 * (i / 3 % 3 - 1), 1.25 + 0.3 * (i / 9 - 1));
  }
  for (int i = 0; i < 36; ++i) {
    const double yaw = 2.0 * std::numbers::pi * i / 36;
    places.emplace_back(-0.2 + 0.75 * std::cos(yaw), 0.75 * std::sin(yaw), 1.3);
    for (const double up : {0.0, 0.5, 1.0, 1.5}) {
      const Vector3d out(std::cos(up) * std::cos(yaw), std::cos(up) * std::sin(yaw), std::sin(up));
      places.emplace_back(Vector3d(0.1, 0.2, 0.95) + 0.5 * out);
    }
  }
  return places;
}

TEST(Office, KeepsAwayFromCameras) {
  for (const Thing& thing : office().things) {
    if (is_shell(thing)) continue;
    const Bounds bounds = bounds_of(thing);
    for (const Vector3d& place : camera_places()) {
      EXPECT_GT(bounds.exteriorDistance(place), 0.35) << thing.name;
    }
  }
}

TEST(Office, LeavesTheLanesFree) {
  const std::map<std::string, Bounds> lanes{
      {"before the camera", {Vector3d(0.45, -2.2, 0.005), Vector3d(0.85, 2.3, 1.9)}},
      {"beyond desk_1", {Vector3d(0.4, 1.77, 0.005), Vector3d(2.25, 2.3, 1.9)}},
      {"before the cabinet", {Vector3d(0.4, -2.2, 0.005), Vector3d(2.6, -1.77, 1.9)}},
      {"behind desk_2", {Vector3d(2.2, -2.2, 0.005), Vector3d(2.8, 1.9, 1.9)}}};
  for (const Thing& thing : office().things) {
    if (thing.id != 0 || is_shell(thing)) continue;
    for (const auto& [name, lane] : lanes) {
      EXPECT_FALSE(lane.intersects(bounds_of(thing))) << thing.name << " stands " << name;
    }
  }
}

TEST(Office, ChairsHaveSeatsAndBacksWhereSittersExpectThem) {
  for (const std::string name : {"chair_1", "chair_2", "chair_3"}) {
    Bounds middle, back;  // of the seat, and of the back behind the sitter
    for (const Eigen::Vector3f& p : thing_named(office(), name).mesh.positions) {
      if (std::hypot(p.x(), p.y()) < 0.15F) middle.extend(p.cast<double>());
      if (p.z() > 0.6F && std::abs(p.y()) < 0.15F) back.extend(p.cast<double>());
    }
    EXPECT_NEAR(middle.max().z(), 0.46, 1e-5) << name;
    EXPECT_NEAR(back.max().z(), 0.92, 1e-5) << name;
    EXPECT_NEAR(back.max().x(), -0.22, 0.02) << name;
    EXPECT_NEAR(bounds_of(thing_named(office(), name)).min().z(), 0.0, 0.002) << name;
  }
}

TEST(Office, StandsWhereItsLayoutSays) {
  const Bounds desk = bounds_of(thing_named(office(), "desk_2"));
  EXPECT_NEAR(desk.min().z(), 0.0, 1e-6);
  EXPECT_TRUE(desk.sizes().isApprox(Vector3d(0.8, 1.6, 0.73), 1e-5));
  EXPECT_NEAR(desk.max().z(), 0.73, 1e-6);
  EXPECT_NEAR(desk.center().x(), 1.75, 1e-6);
  EXPECT_NEAR(desk.center().y(), -0.95, 1e-6);
  const Bounds box = bounds_of(thing_named(office(), "box_1"));
  EXPECT_TRUE(box.sizes().isApprox(Vector3d(0.40, 0.32, 0.30), 1e-5));
  EXPECT_TRUE(box.center().isApprox(Vector3d(1.2, -2.66, 0.90), 1e-6));
  EXPECT_NEAR(bounds_of(thing_named(office(), "cabinet_1")).max().z(), 0.75, 1e-6);
  EXPECT_NEAR(bounds_of(thing_named(office(), "side_table_1")).max().z(), 0.60, 1e-6);
}

// Nothing floats or sinks: a thing that is not on the floor or a wall touches a thing below it.
TEST(Office, ThingsOnTopsTouchThem) {
  for (const char* name : {"monitor_1", "keyboard_1", "mouse_1", "cup_1", "papers_1", "laptop_1"}) {
    EXPECT_NEAR(bounds_of(thing_named(office(), name)).min().z(), 0.73, 2e-3) << name;
  }
}

struct Hashes {
  std::uint64_t shapes = 0;
  std::uint64_t pictures = 0;
};

Hashes hashes_of(const World& world) {
  Hashes hashes;
  const auto mix = [](std::uint64_t& hash, std::uint64_t value) {
    hash = mix_bits(hash ^ mix_bits(value));
  };
  for (const Thing& thing : world.things) {
    for (const Eigen::Vector3f& p : thing.mesh.positions) {
      for (const float c : p) mix(hashes.shapes, std::bit_cast<std::uint32_t>(c));
    }
    for (const Mesh::Triangle& t : thing.mesh.triangles) {
      for (const std::uint32_t corner : t) mix(hashes.shapes, corner);
    }
    for (const double c : thing.T_world_thing.matrix().reshaped()) {
      mix(hashes.shapes, std::bit_cast<std::uint64_t>(c));
    }
  }
  for (std::size_t i = 0; i < world.materials.size(); ++i) {
    const MipTexture& texture = world.materials[static_cast<MaterialId>(i)].texture;
    for (int k = 0; k < 400; ++k) {
      const TexelSum sum = texture.sample({(k % 20 + 0.37F) / 20.F, (k / 20 + 0.61F) / 20.F}, 0.F);
      for (const std::uint32_t channel : sum) mix(hashes.pictures, channel);
    }
  }
  return hashes;
}

TEST(Office, IsAFunctionOfItsSeedWhichVariesPicturesAlone) {
  const Hashes one = hashes_of(office()), again = hashes_of(make_office(1));
  const Hashes other = hashes_of(make_office(2));
  EXPECT_EQ(one.shapes, again.shapes);
  EXPECT_EQ(one.pictures, again.pictures);
  EXPECT_EQ(one.shapes, other.shapes);
  EXPECT_NE(one.pictures, other.pictures);
}

// Equal pictures in two places would confuse place recognition.
TEST(Office, NoTwoPicturesAreEqual) {
  std::map<std::uint64_t, std::size_t> seen;
  for (std::size_t i = 0; i < office().materials.size(); ++i) {
    const MipTexture& texture = office().materials[static_cast<MaterialId>(i)].texture;
    if (texture.width() * texture.height() < 64) continue;  // a plain colour
    std::uint64_t hash = 0;
    for (int k = 0; k < 900; ++k) {
      const TexelSum sum = texture.sample({(k % 30 + 0.37F) / 30.F, (k / 30 + 0.61F) / 30.F}, 0.F);
      for (const std::uint32_t channel : sum) hash = mix_bits(hash ^ mix_bits(channel));
    }
    const auto [first, fresh] = seen.emplace(hash, i);
    EXPECT_TRUE(fresh) << "materials " << first->second << " and " << i;
  }
  EXPECT_GT(seen.size(), 150U);
}

TEST(Office, ItsPicturesFitIntoMemory) {
  std::size_t texels = 0;
  for (std::size_t i = 0; i < office().materials.size(); ++i) {
    const MipTexture& texture = office().materials[static_cast<MaterialId>(i)].texture;
    texels +=
        static_cast<std::size_t>(texture.width()) * static_cast<std::size_t>(texture.height());
  }
  EXPECT_LT(texels, 7'500'000U);  // 40 MB with their smaller copies
}

TEST(Office, LampsHangInTheCeilingAndGlow) {
  ASSERT_FALSE(office().lamps.empty());
  for (const AreaLamp& lamp : office().lamps) {
    EXPECT_GT(lamp.center_world.z(), 2.6);
    EXPECT_LT(lamp.center_world.z(), 2.7);
    EXPECT_NEAR(lamp.half_u_world.dot(lamp.half_v_world), 0.0, 1e-12);
    EXPECT_GT(lamp.power, 0.0);
    const bool has_panel = std::ranges::any_of(office().things, [&](const Thing& thing) {
      const Bounds bounds = bounds_of(thing);  // the light comes from just below it
      return thing.class_name == "lamp" && bounds.exteriorDistance(lamp.center_world) < 0.01;
    });
    EXPECT_TRUE(has_panel);
  }
}

}  // namespace
}  // namespace stillmap
