// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/scene.hpp"

#include <gtest/gtest.h>

#include "stillmap/scene/hash_random.hpp"

namespace stillmap {
namespace {

bool inside(const SceneBox& box, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = box.T_world_box.inverse() * p_world;
  return (p.cwiseAbs().array() <= box.half_size.array()).all();
}

bool solid(const Scene& scene, const Eigen::Vector3d& p_world) {
  for (const SceneBox& box : scene.boxes) {
    if (inside(box, p_world) != box.seen_from_inside) return true;
  }
  return false;
}

// The first solid point along a ray, found by walking: knows nothing of faces or slabs.
double march(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  constexpr double kStep = 0.001;
  double t = 0;
  while (t < 20.0 && !solid(scene, origin + t * direction)) t += kStep;
  return t;
}

Eigen::Vector3d random_direction(HashStream& rng) {
  Eigen::Vector3d d;
  do {
    d = {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
  } while (d.norm() > 1.0 || d.norm() < 0.1);
  return d.normalized();
}

TEST(FirstHit, AgreesWithWalkingAlongTheRay) {
  const Scene scene = make_room(3);
  const Eigen::Vector3d origin(-0.3, 0.1, 1.1);
  HashStream rng(7);
  int furniture = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction = random_direction(rng);
    const std::optional<SceneHit> hit = first_hit(scene, origin, direction);
    ASSERT_TRUE(hit.has_value());
    const double walked = march(scene, origin, direction);
    // Walking may step over less than a step of a box's corner; then it comes out farther.
    if (walked - hit->t > 0.0011) {
      EXPECT_TRUE(solid(scene, origin + (hit->t + 1e-9) * direction));
    } else {
      EXPECT_NEAR(walked, hit->t, 0.0011);
    }
    furniture += scene.boxes[hit->box].seen_from_inside ? 0 : 1;
  }
  EXPECT_GT(furniture, 15);
}

TEST(FirstHit, NamesTheFaceThatThePointLiesOn) {
  const Scene scene = make_room(3);
  HashStream rng(8);
  const Eigen::Vector3d origin(0.2, -0.4, 1.4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction = random_direction(rng);
    const std::optional<SceneHit> hit = first_hit(scene, origin, direction);
    ASSERT_TRUE(hit.has_value());
    const SceneBox& box = scene.boxes[hit->box];
    const Eigen::Vector3d p = box.T_world_box.inverse() * (origin + hit->t * direction);
    const double side = hit->face % 2 == 0 ? -1.0 : 1.0;
    EXPECT_NEAR(p[hit->face / 2], side * box.half_size[hit->face / 2], 1e-12);
  }
}

TEST(FirstHit, MissesWhatLiesBehind) {
  Scene scene;
  SceneBox box;
  box.T_world_box.translation() = Eigen::Vector3d(2, 0, 0);
  box.half_size = Eigen::Vector3d(0.5, 0.5, 0.5);
  scene.boxes.push_back(box);
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  EXPECT_DOUBLE_EQ(first_hit(scene, origin, Eigen::Vector3d::UnitX())->t, 1.5);
  EXPECT_EQ(first_hit(scene, origin, Eigen::Vector3d::UnitX())->face, 0);
  EXPECT_FALSE(first_hit(scene, origin, -Eigen::Vector3d::UnitX()).has_value());
  EXPECT_FALSE(first_hit(scene, origin, Eigen::Vector3d::UnitY()).has_value());
  EXPECT_FALSE(first_hit(scene, {0, 0.6, 0}, Eigen::Vector3d::UnitX()).has_value());
}

TEST(MakeRoom, KeepsItsLayoutAndVariesItsPictures) {
  const Scene a = make_room(1), b = make_room(2);
  ASSERT_EQ(a.boxes.size(), b.boxes.size());
  int different = 0;
  for (std::size_t i = 0; i < a.textures.size(); ++i) {
    ASSERT_EQ(a.textures[i].width(), b.textures[i].width());
    const TexturePoint middle{0.5F, 0.5F};
    different += a.textures[i].sample(middle, 0) != b.textures[i].sample(middle, 0) ? 1 : 0;
  }
  EXPECT_GT(different, static_cast<int>(a.textures.size() / 2));
}

}  // namespace
}  // namespace stillmap
