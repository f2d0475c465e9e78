// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/rigid_alignment.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t n, std::uint32_t seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> points(n);
  for (auto& p : points) p = Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
  return points;
}

double cost(const Eigen::Isometry3d& T,
            const std::vector<Eigen::Vector3d>& source,
            const std::vector<Eigen::Vector3d>& target) {
  double sum = 0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (target[i] - T * source[i]).squaredNorm();
  return sum;
}

TEST(AlignRigid, FindsAnExactTransform) {
  const auto source = random_points(20, 1);
  const Eigen::Isometry3d T = make_pose(so3_exp({0.4, -1.2, 2.0}), {1, 2, -3});
  std::vector<Eigen::Vector3d> target;
  for (const auto& p : source) target.push_back(T * p);
  EXPECT_TRUE(align_rigid(source, target).isApprox(T, 1e-12));
}

TEST(AlignRigid, NoSmallStepBeatsItOnNoisyPoints) {
  const auto source = random_points(50, 2);
  const auto noise = random_points(50, 3);
  const Eigen::Isometry3d T = make_pose(so3_exp({0.1, 0.2, 0.3}), {1, 0, 0});
  std::vector<Eigen::Vector3d> target;
  for (std::size_t i = 0; i < source.size(); ++i) target.push_back(T * source[i] + 0.1 * noise[i]);
  const Eigen::Isometry3d best = align_rigid(source, target);
  for (int axis = 0; axis < 6; ++axis) {
    for (const double h : {-1e-4, 1e-4}) {
      const Eigen::Isometry3d moved = perturb_left(best, h * Vector6d::Unit(axis));
      EXPECT_GT(cost(moved, source, target), cost(best, source, target));
    }
  }
}

// One point, two, and points on a line or on a plane: some rotations are as good as others, and one
// of them is returned.
TEST(AlignRigid, FindsOneOfTheBestWhereARotationIsUndetermined) {
  const Eigen::Isometry3d T = make_pose(so3_exp({0.4, -1.2, 2.0}), {1, 2, -3});
  const Eigen::Vector3d at(0.3, -2, 1), along(1, 2, -1), across(0, 1, 2);
  const std::vector<std::vector<Eigen::Vector3d>> sets = {
      {at},
      {at, at},
      {at, at + along},
      {at, at + along, at - 3 * along, at + 0.1 * along},
      {at, at + along, at + across, at - along + 2 * across}};
  for (const std::vector<Eigen::Vector3d>& source : sets) {
    std::vector<Eigen::Vector3d> target;
    for (const auto& p : source) target.push_back(T * p);
    const Eigen::Isometry3d best = align_rigid(source, target);
    EXPECT_LT(cost(best, source, target), 1e-24) << source.size();
    EXPECT_NEAR(best.linear().determinant(), 1.0, 1e-12) << source.size();
    EXPECT_TRUE((best.linear().transpose() * best.linear()).isIdentity(1e-12)) << source.size();
  }
}

TEST(AlignRigid, NeverReflects) {
  auto source = random_points(10, 4);
  auto target = source;
  for (auto& p : target) p.x() = -p.x();
  EXPECT_NEAR(align_rigid(source, target).linear().determinant(), 1.0, 1e-12);
}

}  // namespace
}  // namespace stillmap
