// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/person_shape.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

using Eigen::Vector3f;

// A closed surface has each edge once in each direction.
int open_edges(const std::vector<Mesh::Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Mesh::Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i];
      const std::uint32_t b = t[(i + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return static_cast<int>(
      std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; }));
}

float volume(const FleshSurface& surface) {
  float sum = 0.F;
  for (const Mesh::Triangle& t : surface.triangles) {
    sum +=
        surface.positions[t[0]].dot(surface.positions[t[1]].cross(surface.positions[t[2]])) / 6.F;
  }
  return sum;
}

TEST(Flesh, ABallIsMeshedAsABall) {
  FleshPart ball;
  ball.from = ball.to = Vector3f(0.1F, 0.2F, -0.1F);
  ball.from_radius = ball.to_radius = 0.3F;
  const FleshSurface surface =
      surface_of(Flesh({ball}), Vector3f::Constant(-0.6F), Vector3f::Constant(0.6F), 0.02F);
  EXPECT_EQ(open_edges(surface.triangles), 0);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3f out = surface.positions[i] - ball.from;
    EXPECT_NEAR(out.norm(), 0.3F, 1e-4F);
    EXPECT_GT(surface.normals[i].dot(out.normalized()), 0.9999F);
  }
  const float expected = 4.F / 3.F * float(std::numbers::pi) * 0.027F;
  EXPECT_NEAR(volume(surface), expected, 0.01F * expected);  // positive: turned outwards
}

TEST(Flesh, PartsOfOneLayerMeltAndLayersDoNot) {
  FleshPart a;
  a.from_radius = a.to_radius = 0.1F;
  a.from = a.to = Vector3f(-0.11F, 0, 0);
  FleshPart b = a;
  b.from = b.to = Vector3f(0.11F, 0, 0);
  a.blend_m = b.blend_m = 0.05F;
  EXPECT_LT(Flesh({a, b}).sample(Vector3f::Zero()).distance, 0.F);
  b.layer = 1;
  EXPECT_NEAR(Flesh({a, b}).sample(Vector3f::Zero()).distance, 0.01F, 1e-6F);
}

TEST(PersonShape, IsClosedAndAsTallAsItShouldBe) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const PersonLook look = random_look(seed);
    EXPECT_GE(look.height_m, 1.60);
    EXPECT_LE(look.height_m, 1.88);
    const FleshSurface surface = surface_of(
        person_flesh(look), Vector3f(-0.28F, -0.56F, -1.1F), Vector3f(0.28F, 0.56F, 1.0F), 0.02F);
    EXPECT_EQ(open_edges(surface.triangles), 0) << seed;
    Eigen::AlignedBox3f box;
    for (const Vector3f& p : surface.positions) box.extend(p);
    EXPECT_NEAR(box.sizes().z(), look.height_m, 0.04) << seed;
    EXPECT_NEAR(box.min().z(), -rest_pelvis_height(look), 0.015) << seed;
    // A human of density 1: 45 to 120 kg.
    EXPECT_GT(volume(surface), 0.045F) << seed;
    EXPECT_LT(volume(surface), 0.120F) << seed;
  }
}

// At rest the arms are apart from the trunk and the legs from each other.
TEST(PersonShape, LimbsAreApartAtRest) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const PersonLook look = random_look(seed);
    const Flesh flesh = person_flesh(look);
    const float scale = static_cast<float>(look.height_m / 1.75);
    EXPECT_GT(flesh.sample(scale * Vector3f(0, 0, -0.35F)).distance, 0.F)
        << seed;  // above the knees
    const auto& joints = person_skeleton(look).positions;
    const Vector3f elbow = joints[std::size_t(Joint::kLeftElbow)].cast<float>();
    bool gap = false;
    for (float y = 0.1F; y < elbow.y(); y += 0.004F) {
      gap = gap || flesh.sample(Vector3f(0, y, elbow.z())).distance > 0.002F;
    }
    EXPECT_TRUE(gap) << seed;
  }
}

// Trousers don't show through a shirt that is worn over them.
TEST(PersonShape, LooseShirtsCoverTheHips) {
  PersonLook look;
  look.tucked_in = false;
  for (const double girth : {0.93, 1.05, 1.17}) {
    for (const double feminine : {0.0, 1.0}) {
      look.girth = girth;
      look.feminine = feminine;
      const Flesh flesh = person_flesh(look);
      for (float angle = 0.F; angle < 6.3F; angle += 0.2F) {
        for (const float z : {-0.045F, -0.02F, 0.02F, 0.06F}) {
          const Vector3f out(std::cos(angle), std::sin(angle), 0.F);
          float away = 0.215F;  // within the arms
          while (flesh.sample(away * out + z * Vector3f::UnitZ()).distance > 0.F) away -= 0.002F;
          const FleshSample outermost = flesh.sample(away * out + z * Vector3f::UnitZ());
          EXPECT_EQ(outermost.layer, static_cast<std::uint8_t>(PersonLayer::kShirt))
              << girth << " " << feminine << " " << angle << " " << z;
        }
      }
    }
  }
}

TEST(PersonShape, TheMeshIsWholeAndPainted) {
  MaterialLibrary materials;
  const Body body = make_person(random_look(4), materials);
  const Mesh& mesh = body.rest();
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
  EXPECT_EQ(mesh.materials.size(), mesh.triangles.size());
  EXPECT_GT(mesh.triangles.size(), 6000U);
  EXPECT_LT(mesh.triangles.size(), 24000U);
  std::vector<int> used(materials.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    ASSERT_LT(mesh.materials[i], materials.size());
    ++used[mesh.materials[i]];
    for (const std::uint32_t corner : mesh.triangles[i]) ASSERT_LT(corner, mesh.positions.size());
  }
  EXPECT_GE(std::count_if(used.begin(), used.end(), [](int n) { return n > 20; }), 8);
}

TEST(PersonShape, TheSameNumberGivesTheSamePerson) {
  MaterialLibrary a;
  MaterialLibrary b;
  EXPECT_EQ(make_person(random_look(9), a).rest().positions,
            make_person(random_look(9), b).rest().positions);
  EXPECT_NE(random_look(9).height_m, random_look(10).height_m);
}

}  // namespace
}  // namespace stillmap
