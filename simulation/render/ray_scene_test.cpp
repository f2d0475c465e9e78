// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/ray_scene.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/render_scenes.hpp"

namespace stillmap {
namespace {

struct Nearest {
  double t = 1e9;
  std::uint32_t object = SurfaceHit::kNothing;
};

// Tests every triangle by the linear system o + t d = a + u (b - a) + v (c - a).
Nearest brute_force(const World& world, const WorldState& state, const Ray& ray) {
  Nearest nearest;
  for (std::uint32_t i = 0; i < world.things.size(); ++i) {
    const Mesh& mesh = world.things[i].mesh;
    const Eigen::Isometry3d& T = state.T_world_things[i];
    for (const Mesh::Triangle& triangle : mesh.triangles) {
      const Eigen::Vector3d a = T * mesh.positions[triangle[0]].cast<double>();
      const Eigen::Vector3d b = T * mesh.positions[triangle[1]].cast<double>();
      const Eigen::Vector3d c = T * mesh.positions[triangle[2]].cast<double>();
      Eigen::Matrix3d system;
      system << -ray.direction.cast<double>(), b - a, c - a;
      const Eigen::Vector3d tuv = system.inverse() * (ray.origin.cast<double>() - a);
      const bool inside = tuv.y() >= 0 && tuv.z() >= 0 && tuv.y() + tuv.z() <= 1;
      if (inside && tuv.x() > 1e-4 && tuv.x() < nearest.t) nearest = {tuv.x(), i};
    }
  }
  return nearest;
}

std::vector<Ray> random_rays(unsigned seed, std::size_t count) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> uniform(-0.5F, 0.5F);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.direction = Eigen::Vector3f(1.F, uniform(rng), uniform(rng));
  }
  return rays;
}

struct Comparison {
  int met = 0, differ = 0;
};

Comparison compare(const RayScene& scene,
                   const World& world,
                   const WorldState& state,
                   const std::vector<Ray>& rays,
                   std::size_t moment = kMiddle) {
  Comparison result;
  for (std::size_t first = 0; first < rays.size(); first += kRays) {
    const std::span<const Ray> packet(&rays[first], std::min(kRays, rays.size() - first));
    const std::array<SurfaceHit, kRays> hits = scene.first_hits(packet, moment);
    const std::uint32_t blocked = scene.blocked(packet);
    for (std::size_t i = 0; i < packet.size(); ++i) {
      const Nearest expected = brute_force(world, state, packet[i]);
      result.met += hits[i].valid() ? 1 : 0;
      const bool same = hits[i].object == expected.object &&
                        (!hits[i].valid() || std::abs(hits[i].t - expected.t) < 1e-4) &&
                        (moment != kMiddle || ((blocked >> i & 1U) != 0) == hits[i].valid());
      result.differ += same ? 0 : 1;
    }
  }
  return result;
}

TEST(RayScene, FindsWhatTryingEveryTriangleFinds) {
  const auto world = std::make_shared<const World>(random_world(3));
  const WorldGeometry geometry(world);
  const WorldState state = rest_state(*world);
  const RayScene scene(geometry, Exposure::still(Eigen::Isometry3d::Identity(), state));
  const Comparison found = compare(scene, *world, state, random_rays(7, 1003));
  EXPECT_GT(found.met, 200);
  EXPECT_LE(found.differ, 2);  // rays that graze a triangle's edge
}

TEST(RayScene, KnowsWhereMovingThingsAreInBetween) {
  const auto world = std::make_shared<const World>(random_world(4));
  const WorldGeometry geometry(world);
  Exposure exposure = Exposure::still(Eigen::Isometry3d::Identity(), rest_state(*world));
  exposure.close.T_world_things[2].translation() += Eigen::Vector3d(0, 0.4, 0.2);
  const RayScene scene(geometry, exposure);
  const std::vector<Ray> rays = random_rays(8, 1000);
  for (std::size_t moment = 0; moment < kMoments.size(); ++moment) {
    WorldState between = exposure.open;
    between.T_world_things[2].translation() += kMoments[moment] * Eigen::Vector3d(0, 0.4, 0.2);
    EXPECT_LE(compare(scene, *world, between, rays, moment).differ, 2);
    EXPECT_GT(compare(scene, *world, exposure.open, rays, moment).differ, 5);
  }
}

TEST(RayScene, RaysEndAtTheirReach) {
  World made;
  const MaterialId gray = made.materials.add_plain({128, 128, 128});
  made.things.push_back({"wall", "wall", 0, wall(2.0, 1, 1, gray), Eigen::Isometry3d::Identity()});
  const auto world = std::make_shared<const World>(made);
  const WorldGeometry geometry(world);
  const RayScene scene(geometry,
                       Exposure::still(Eigen::Isometry3d::Identity(), rest_state(*world)));
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero(), ahead(0.5F, 0.F, 0.F);
  const std::array<Ray, 2> rays{{{origin, ahead, 3.9F}, {origin, ahead, 4.1F}}};
  EXPECT_EQ(scene.blocked(rays), 2U);
  const SurfaceHit hit = scene.first_hits(rays)[1];
  EXPECT_NEAR(hit.t, 4.F, 1e-5F);
  EXPECT_EQ(scene.mask_id(hit.object), 0);
  EXPECT_EQ(scene.triangle(hit).material, gray);
}

}  // namespace
}  // namespace stillmap
