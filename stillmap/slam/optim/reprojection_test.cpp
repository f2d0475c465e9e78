// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/reprojection.hpp"

#include <gtest/gtest.h>

#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

constexpr double kJacobianTolerance = 1e-6;  // of central differences, relative

TEST(Reprojection, ResidualByHand) {
  CameraModel camera;
  camera.fx = 100, camera.fy = 200, camera.cx = 50, camera.cy = 40;
  PointMeasurement m;
  m.px = {70, 50};
  m.pixel_weight = 0.5;
  m.inverse_depth = 0.25;
  m.inverse_depth_weight = 8;
  // u = 100 * 1/2 + 50 = 100, v = 200 * 0.5/2 + 40 = 90, 1/z = 0.5.
  const Eigen::Vector3d r = reprojection_residual(camera, m, {1.0, 0.5, 2.0});
  EXPECT_TRUE(r.isApprox(Eigen::Vector3d(15, 20, 2), 1e-15)) << r.transpose();
}

TEST(Reprojection, WithoutDepthTheThirdPartIsZeroAndTheBoundIsThatOfTwo) {
  PointMeasurement m;
  EXPECT_FALSE(m.has_depth());
  EXPECT_EQ(chi2_bound(m), 5.991);
  EXPECT_EQ(reprojection_residual(builtin_camera("tum_fr3"), m, {1.0, 0.5, 2.0}).z(), 0.0);
  m.inverse_depth_weight = 1;
  EXPECT_TRUE(m.has_depth());
  EXPECT_EQ(chi2_bound(m), 7.815);
}

// Chi-squared with 2 degrees of freedom is exponential; with 3 the distribution is known in closed
// form too.
TEST(Reprojection, BoundsHold95Percent) {
  EXPECT_NEAR(1 - std::exp(-0.5 * kChi2Bound2), 0.95, 1e-4);
  const double x = kChi2Bound3;
  const double pi = 3.14159265358979;
  EXPECT_NEAR(std::erf(std::sqrt(x / 2)) - std::sqrt(2 * x / pi) * std::exp(-x / 2), 0.95, 1e-4);
}

TEST(Reprojection, JacobianByThePointEqualsCentralDifferences) {
  const PoseScene scene = make_pose_scene(3, 50, Depths::kSome, 1.0);
  for (const PoseObservation& o : scene.observations) {
    const Eigen::Vector3d p_camera = scene.T_camera_world * o.p_world;
    const Eigen::MatrixXd expected = numeric_jacobian(
        [&](const Eigen::VectorXd& p) -> Eigen::VectorXd {
          return reprojection_residual(scene.camera, o.measurement, p);
        },
        p_camera);
    const Eigen::Matrix3d J = reprojection_jacobian(scene.camera, o.measurement, p_camera);
    EXPECT_LT((J - expected).norm(), kJacobianTolerance * expected.norm());
  }
}

TEST(Reprojection, JacobianByThePoseEqualsCentralDifferences) {
  const PoseScene scene = make_pose_scene(4, 50, Depths::kSome, 1.0);
  for (const PoseObservation& o : scene.observations) {
    const Eigen::MatrixXd expected = numeric_jacobian(
        [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
          return reprojection_residual(
              scene.camera, o.measurement, perturb_left(scene.T_camera_world, step) * o.p_world);
        },
        Eigen::VectorXd::Zero(6));
    const Eigen::Vector3d p_camera = scene.T_camera_world * o.p_world;
    const Eigen::Matrix<double, 3, 6> J =
        pose_jacobian(reprojection_jacobian(scene.camera, o.measurement, p_camera), p_camera);
    EXPECT_LT((J - expected).norm(), kJacobianTolerance * expected.norm());
  }
}

TEST(Reprojection, EquationsOfThePoseAreThoseOfItsJacobian) {
  const PoseScene scene = make_pose_scene(5, 50, Depths::kSome, 1.0);
  for (const PoseObservation& o : scene.observations) {
    const Eigen::Vector3d p_camera = scene.T_camera_world * o.p_world;
    const Eigen::Vector3d r = reprojection_residual(scene.camera, o.measurement, p_camera);
    const Eigen::Matrix<double, 3, 6> J =
        pose_jacobian(reprojection_jacobian(scene.camera, o.measurement, p_camera), p_camera);
    Matrix6d H = Matrix6d::Identity();  // they are added to what is there
    Vector6d g = Vector6d::Ones();
    add_to_pose(point_equations(scene.camera, o.measurement, p_camera, r, 0.7), p_camera, H, g);
    const Matrix6d expected_H = Matrix6d::Identity() + 0.7 * J.transpose() * J;
    const Vector6d expected_g = Vector6d::Ones() + 0.7 * J.transpose() * r;
    const Matrix6d both = H.selfadjointView<Eigen::Lower>();
    EXPECT_LT((both - expected_H).norm(), 1e-12 * expected_H.norm());
    EXPECT_LT((g - expected_g).norm(), 1e-12 * expected_g.norm());
  }
}

// Huber 1964: r^2 inside |r| <= k, 2 k |r| - k^2 outside.
TEST(Huber, IsItsDefinition) {
  for (const double k : {0.5, 1.0, 2.448}) {
    for (const double r : {0.0, 0.1, 0.5, 0.9, 1.0, 1.1, 2.4, 2.5, 10.0, 1e6}) {
      const double expected = r <= k ? r * r : 2 * k * r - k * k;
      EXPECT_NEAR(Huber(r * r, k * k).cost, expected, 1e-12 * (1 + expected)) << r << " " << k;
    }
  }
}

TEST(Huber, WeightIsTheDerivativeOfTheCost) {
  const double bound = 5.991;
  for (const double chi2 : {0.5, 3.0, 5.9, 6.1, 20.0, 1000.0}) {
    const double h = 1e-5 * chi2;
    const double slope = (Huber(chi2 + h, bound).cost - Huber(chi2 - h, bound).cost) / (2 * h);
    EXPECT_NEAR(Huber(chi2, bound).weight, slope, 1e-8) << chi2;
  }
}

TEST(Huber, CostAndWeightAreContinuousAtTheBound) {
  const Huber below(kChi2Bound2 - 1e-9, kChi2Bound2), above(kChi2Bound2 + 1e-9, kChi2Bound2);
  EXPECT_NEAR(below.cost, above.cost, 1e-8);
  EXPECT_NEAR(below.weight, above.weight, 1e-8);
}

}  // namespace
}  // namespace stillmap
