// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_graph.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/rigid_alignment.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/optim/pose_residual.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

Eigen::Isometry3d random_pose(TestRandom& random) {
  return perturb_left(Eigen::Isometry3d::Identity(), random.twist(2.0, 1.0));
}

// Root of the mean squared distance of the positions after the best rigid alignment.
double ate_m(const std::vector<Eigen::Isometry3d>& truth,
             const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<Eigen::Vector3d> source, target;
  for (const Eigen::Isometry3d& T : poses) source.push_back(T.translation());
  for (const Eigen::Isometry3d& T : truth) target.push_back(T.translation());
  const Eigen::Isometry3d T = align_rigid(source, target);
  double sum = 0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (T * source[i] - target[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(source.size()));
}

struct Circle {
  std::vector<Eigen::Isometry3d> truth;
  PoseGraph graph;
};

// 120 key frames on a circle of 2 m that looks outwards; each step is measured with noise and a
// small constant error of the turn, as is every other step, and the poses are summed up from that.
Circle drifting_circle(std::uint32_t seed) {
  constexpr std::uint32_t kCount = 120;
  TestRandom random(seed);
  Circle circle;
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCount;
    circle.truth.push_back(make_pose(
        so3_exp(Eigen::Vector3d(0, angle, 0)),
        2.0 * Eigen::Vector3d(std::sin(angle), 0.05 * std::sin(3 * angle), std::cos(angle))));
  }
  const auto measured = [&](std::uint32_t from, std::uint32_t to) {
    const Eigen::Isometry3d T = circle.truth[from].inverse() * circle.truth[to];
    Vector6d error = random.twist(0.003, 0.0008);
    error[4] += 0.001;
    return perturb_left(T, error);
  };
  circle.graph.T_world = {circle.truth[0]};
  circle.graph.held.assign(kCount, 0);
  circle.graph.held[0] = 1;
  for (std::uint32_t k = 1; k < kCount; ++k) {
    circle.graph.edges.push_back({k - 1, k, measured(k - 1, k), 0.003, 0.0015});
    if (k > 1) circle.graph.edges.push_back({k - 2, k, measured(k - 2, k), 0.004, 0.002});
    const PoseGraphEdge& step = circle.graph.edges[k == 1 ? 0 : 2 * k - 3];
    circle.graph.T_world.push_back(circle.graph.T_world[k - 1] * step.T_from_to);
  }
  return circle;
}

PoseGraphEdge true_edge(const Circle& circle, std::uint32_t from, std::uint32_t to) {
  return {from, to, circle.truth[from].inverse() * circle.truth[to], 0.005, 0.003};
}

TEST(PoseGraph, ResidualIsTheErrorOfTheEdge) {
  TestRandom random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d T_from = random_pose(random), T_to = random_pose(random);
    const Vector6d error = random.twist(0.3, 0.05);
    const PoseGraphEdge edge{
        0,
        1,
        T_from.inverse() * T_to * perturb_left(Eigen::Isometry3d::Identity(), error).inverse(),
        0.1,
        0.02};
    Eigen::Matrix<double, 6, 1> r;
    PoseResidual{edge}(pose_block(T_from).data(), pose_block(T_to).data(), r.data());
    EXPECT_LT((r.head<3>() * 0.1 - error.head<3>()).norm(), 1e-9);
    // Twice the sine of half the angle for the angle itself.
    EXPECT_LT((r.tail<3>() * 0.02 - error.tail<3>()).norm(), 0.05 * error.tail<3>().norm());
  }
}

TEST(PoseGraph, ResidualDoesNotDependOnTheQuaternionsSign) {
  TestRandom random(2);
  const PoseGraphEdge edge{0, 1, random_pose(random), 0.1, 0.1};
  const PoseBlock from = pose_block(random_pose(random));
  PoseBlock to = pose_block(random_pose(random));
  Eigen::Matrix<double, 6, 1> r, same;
  PoseResidual{edge}(from.data(), to.data(), r.data());
  for (std::size_t i = 0; i < 4; ++i) to[i] = -to[i];
  PoseResidual{edge}(from.data(), to.data(), same.data());
  EXPECT_LT((r - same).norm(), 1e-12);
}

TEST(PoseGraph, JacobiansAreThoseOfNumericDerivatives) {
  TestRandom random(3);
  for (int i = 0; i < 10; ++i) {
    const PoseBlock from = pose_block(random_pose(random)), to = pose_block(random_pose(random));
    const PoseGraphEdge edge{0, 1, random_pose(random), 0.5, 0.2};
    const ceres::AutoDiffCostFunction<PoseResidual, 6, 7, 7> cost(new PoseResidual(edge));
    Eigen::Matrix<double, 6, 1> residual;
    Eigen::Matrix<double, 6, 7, Eigen::RowMajor> J_from, J_to;
    const std::array<const double*, 2> blocks{from.data(), to.data()};
    std::array<double*, 2> jacobians{J_from.data(), J_to.data()};
    ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), jacobians.data()));
    Eigen::VectorXd x(14);
    for (Eigen::Index k = 0; k < 7; ++k) {
      x[k] = from[static_cast<std::size_t>(k)];
      x[7 + k] = to[static_cast<std::size_t>(k)];
    }
    const auto f = [&](const Eigen::VectorXd& at) {
      Eigen::VectorXd r(6);
      PoseResidual{edge}(at.data(), at.data() + 7, r.data());
      return r;
    };
    const Eigen::MatrixXd numeric = numeric_jacobian(f, x);
    EXPECT_LT((numeric.leftCols(7) - J_from).norm(), 1e-6 * J_from.norm());
    EXPECT_LT((numeric.rightCols(7) - J_to).norm(), 1e-6 * J_to.norm());
  }
}

TEST(PoseGraph, OneLoopTakesTheDriftOutOfACircle) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    Circle circle = drifting_circle(seed);
    const double before = ate_m(circle.truth, circle.graph.T_world);
    circle.graph.edges.push_back(true_edge(circle, 0, 119));
    const PoseGraphResult result = optimize_pose_graph(circle.graph, {});
    const double after = ate_m(circle.truth, result.T_world);
    EXPECT_TRUE(result.converged);
    EXPECT_GT(before, 0.05) << seed;
    EXPECT_LT(after, before / 3) << seed;
    EXPECT_LT(after, 0.02) << seed;
    EXPECT_LT(result.final_cost, result.initial_cost);
    EXPECT_EQ(result.chi2.size(), circle.graph.edges.size());
  }
}

// A rotation of a quarter turn that has to be spread: far from where a linear step would do.
TEST(PoseGraph, SpreadsALargeErrorEvenly) {
  PoseGraph graph;
  constexpr std::uint32_t kCount = 10;
  const Eigen::Isometry3d step = make_pose(so3_exp(Eigen::Vector3d(0, 0, 0.1)), {1, 0, 0});
  graph.T_world = {Eigen::Isometry3d::Identity()};
  graph.held.assign(kCount, 0);
  graph.held[0] = 1;
  for (std::uint32_t k = 1; k < kCount; ++k) {
    graph.T_world.push_back(graph.T_world.back() * step);
    graph.edges.push_back({k - 1, k, step, 1e3, 0.01});  // turns alone
  }
  const Eigen::Isometry3d end =
      make_pose(so3_exp(Eigen::Vector3d(0, 0, 0.9 + 0.45 * std::numbers::pi)), {0, 0, 0});
  graph.edges.push_back({0, kCount - 1, end, 1e3, 1e-6});
  const PoseGraphResult result = optimize_pose_graph(graph, {});
  EXPECT_TRUE(result.converged);
  for (std::uint32_t k = 1; k < kCount; ++k) {
    const Eigen::Matrix3d turn =
        result.T_world[k - 1].linear().transpose() * result.T_world[k].linear();
    EXPECT_NEAR(rotation_angle(turn), 0.1 + 0.05 * std::numbers::pi, 1e-4);
  }
}

TEST(PoseGraph, AnExactGraphStaysAndHeldPosesKeepTheirBits) {
  Circle circle = drifting_circle(1);
  circle.graph.held[50] = 1;
  PoseGraph exact = circle.graph;
  for (PoseGraphEdge& edge : exact.edges) {
    edge.T_from_to = exact.T_world[edge.from].inverse() * exact.T_world[edge.to];
  }
  const PoseGraphResult stays = optimize_pose_graph(exact, {});
  circle.graph.edges.push_back(true_edge(circle, 0, 119));
  const PoseGraphResult result = optimize_pose_graph(circle.graph, {});
  for (std::size_t k = 0; k < 120; ++k) {
    EXPECT_LT(pose_distance(stays.T_world[k], exact.T_world[k]), 1e-9);
  }
  for (const std::size_t k : {0U, 50U}) {
    EXPECT_EQ(result.T_world[k].matrix(), circle.graph.T_world[k].matrix());
  }
}

TEST(PoseGraph, WrongLoopShowsInItsChi2) {
  Circle circle = drifting_circle(2);
  circle.graph.edges.push_back(true_edge(circle, 0, 119));
  circle.graph.edges.push_back(true_edge(circle, 3, 117));
  PoseGraphEdge wrong = true_edge(circle, 20, 80);
  wrong.T_from_to = true_edge(circle, 20, 22).T_from_to;
  const double fits = optimize_pose_graph(circle.graph, {}).chi2.back();
  circle.graph.edges.push_back(wrong);
  EXPECT_LT(fits, 100);
  EXPECT_GT(optimize_pose_graph(circle.graph, {}).chi2.back(), 1000);
}

TEST(PoseGraph, IsTheSameBitsEachTime) {
  Circle circle = drifting_circle(3);
  circle.graph.edges.push_back(true_edge(circle, 0, 119));
  const PoseGraphResult first = optimize_pose_graph(circle.graph, {});
  const PoseGraphResult second = optimize_pose_graph(circle.graph, {});
  for (std::size_t k = 0; k < first.T_world.size(); ++k) {
    EXPECT_EQ(first.T_world[k].matrix(), second.T_world[k].matrix());
  }
  EXPECT_EQ(first.chi2, second.chi2);
}

TEST(PoseGraph, OddGraphs) {
  EXPECT_TRUE(optimize_pose_graph({}, {}).T_world.empty());
  const PoseGraph alone{{Eigen::Isometry3d::Identity()}, {1}, {}};
  EXPECT_EQ(optimize_pose_graph(alone, {}).T_world.size(), 1U);
  Circle circle = drifting_circle(4);
  circle.graph.T_world[7].translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)optimize_pose_graph(circle.graph, {}), Error);
}

}  // namespace
}  // namespace stillmap
