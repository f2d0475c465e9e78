// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/bundle_adjuster.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

constexpr BundleConfig kThorough{.robust_iterations = 30, .final_iterations = 30};

bool all_finite(const BundleResult& result) {
  bool finite = std::isfinite(result.initial_cost) && std::isfinite(result.final_cost);
  for (const Eigen::Isometry3d& T : result.T_camera_world) {
    finite = finite && T.matrix().allFinite();
  }
  for (const Eigen::Vector3d& p : result.points) finite = finite && p.allFinite();
  return finite;
}

double huber_cost(const BundleProblem& problem, const BundleResult& result) {
  double cost = 0;
  for (const BundleObservation& o : problem.observations) {
    const Eigen::Vector3d p_camera = result.T_camera_world[o.camera] * result.points[o.point];
    const double norm = reprojection_residual(problem.camera, o.measurement, p_camera).norm();
    const double bound = std::sqrt(o.measurement.has_depth() ? 7.815 : 5.991);
    cost += norm <= bound ? norm * norm : 2 * bound * norm - bound * bound;
  }
  return cost;
}

TEST(BundleAdjuster, ExactProblemConvergesToTheTruth) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const BundleProblem truth = make_bundle({.seed = seed, .seen = 0.7});
    const BundleResult result = adjust_bundle(perturbed(truth, seed + 50, 0.03), kThorough);
    EXPECT_GT(result.initial_cost, 1e4);
    EXPECT_LT(result.final_cost, 1e-9);
    for (std::size_t c = 0; c < truth.held.size(); ++c) {
      EXPECT_LT(pose_distance(result.T_camera_world[c], truth.T_camera_world[c]), 1e-6) << c;
    }
    for (std::size_t p = 0; p < truth.points.size(); ++p) {
      EXPECT_LT((result.points[p] - truth.points[p]).norm(), 1e-5) << p;
    }
    EXPECT_EQ(std::accumulate(result.inlier.begin(), result.inlier.end(), std::size_t{0}),
              truth.observations.size());
  }
}

TEST(BundleAdjuster, ReportsTheCostsOfWhatItWasGivenAndReturns) {
  const BundleProblem problem =
      perturbed(make_bundle({.seed = 3, .seen = 0.7, .noise = 1.0}), 4, 0.01);
  const BundleResult result = adjust_bundle(problem, {});
  BundleResult start;
  start.T_camera_world = problem.T_camera_world;
  start.points = problem.points;
  EXPECT_NEAR(result.initial_cost, huber_cost(problem, start), 1e-9 * result.initial_cost);
  EXPECT_NEAR(result.final_cost, huber_cost(problem, result), 1e-9 * result.final_cost);
  EXPECT_LT(result.final_cost, result.initial_cost);
  EXPECT_GT(result.iterations, 0);
  EXPECT_LE(result.iterations, 10);
}

TEST(BundleAdjuster, CountsTheIterationThatConverges) {
  const BundleProblem problem = make_bundle({.seed = 26, .noise = 1.0});
  BundleProblem solved = problem;
  for (int round = 0; round < 3; ++round) {
    const BundleResult result =
        adjust_bundle(solved, {.robust_iterations = 50, .final_iterations = 0});
    solved.T_camera_world = result.T_camera_world;
    solved.points = result.points;
  }
  // At the optimum the first step that is not refused is the last.
  const BundleResult again = adjust_bundle(solved, {.robust_iterations = 1, .final_iterations = 0});
  EXPECT_EQ(again.iterations, 1);
  EXPECT_LE(again.final_cost, again.initial_cost);
}

TEST(BundleAdjuster, HeldCamerasDoNotMove) {
  BundleProblem problem = perturbed(make_bundle({.seed = 5, .noise = 1.0}), 6, 0.02);
  problem.held.assign(problem.held.size(), 0);
  problem.held[1] = problem.held[4] = problem.held[7] = 1;
  const BundleResult result = adjust_bundle(problem, {});
  for (std::size_t c = 0; c < problem.held.size(); ++c) {
    const bool same = result.T_camera_world[c].matrix() == problem.T_camera_world[c].matrix();
    EXPECT_EQ(same, problem.held[c] != 0) << c;
  }
}

TEST(BundleAdjuster, PointSeenByHeldCamerasOnlyStillMoves) {
  BundleProblem truth = make_bundle({.seed = 7});
  std::erase_if(truth.observations, [&](const BundleObservation& o) {
    return o.point == 20 && truth.held[o.camera] == 0;
  });
  const BundleProblem problem = perturbed(truth, 8, 0.03);
  const BundleResult result = adjust_bundle(problem, kThorough);
  EXPECT_GT((problem.points[20] - truth.points[20]).norm(), 0.01);
  EXPECT_LT((result.points[20] - truth.points[20]).norm(), 1e-5);
}

TEST(BundleAdjuster, FlagsOutliersAndStaysAtTheTruth) {
  BundleProblem truth = make_bundle({.seed = 9, .noise = 0.1});
  TestRandom random(10);
  std::vector<std::uint8_t> wrong(truth.observations.size(), 0);
  for (std::size_t i = 0; i < wrong.size(); i += 17) {
    const double angle = random.uniform(0, 6.28);
    wrong[i] = 1;
    truth.observations[i].measurement.px += 40 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  const BundleResult result = adjust_bundle(perturbed(truth, 11, 0.01), kThorough);
  for (std::size_t i = 0; i < wrong.size(); ++i) EXPECT_EQ(result.inlier[i], 1 - wrong[i]) << i;
  for (std::size_t c = 0; c < truth.held.size(); ++c) {
    EXPECT_LT(pose_distance(result.T_camera_world[c], truth.T_camera_world[c]), 1e-3) << c;
  }
}

TEST(BundleAdjuster, EqualInputGivesEqualBits) {
  const BundleProblem problem =
      perturbed(make_bundle({.seed = 12, .seen = 0.5, .noise = 1.0}), 13, 0.02);
  const BundleResult a = adjust_bundle(problem, {}), b = adjust_bundle(problem, {});
  for (std::size_t c = 0; c < a.T_camera_world.size(); ++c) {
    EXPECT_EQ(a.T_camera_world[c].matrix(), b.T_camera_world[c].matrix());
  }
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.inlier, b.inlier);
  EXPECT_EQ(a.final_cost, b.final_cost);
}

TEST(BundleAdjuster, ObservationsBehindTheCameraTakeNoPart) {
  BundleProblem truth = make_bundle({.seed = 14});
  std::vector<std::uint8_t> behind(truth.observations.size(), 0);
  // Point 3 stands behind all cameras.
  truth.points[3].z() = -truth.points[3].z();
  for (std::size_t i = 0; i < behind.size(); ++i) behind[i] = truth.observations[i].point == 3;
  const BundleProblem problem = perturbed(truth, 15, 0.02);
  const BundleResult result = adjust_bundle(problem, kThorough);
  EXPECT_TRUE(all_finite(result));
  EXPECT_LT(result.final_cost, 1e-9);
  EXPECT_EQ(result.points[3], problem.points[3]);
  for (std::size_t i = 0; i < behind.size(); ++i) EXPECT_EQ(result.inlier[i], 1 - behind[i]) << i;
}

// An outlier at the start's very front: the true pose has the point behind the camera.
TEST(BundleAdjuster, CostStaysFiniteWhenAnOutlierEndsBehindTheCamera) {
  BundleProblem problem = make_bundle({.seed = 16});
  const std::size_t moving = 5;
  const auto point = static_cast<std::uint32_t>(problem.points.size());
  const Eigen::Isometry3d T_true = problem.T_camera_world[moving];
  problem.points.push_back(T_true.inverse() * Eigen::Vector3d(0, 0, 0.02));
  PointMeasurement m;
  m.px = {400, 300};
  problem.observations.push_back({0, point, m});
  problem.observations.push_back({static_cast<std::uint32_t>(moving), point, m});
  // 8 cm back, the point lies 10 cm before the camera.
  problem.T_camera_world[moving].translation().z() += 0.08;
  const BundleResult result = adjust_bundle(problem, kThorough);
  EXPECT_TRUE(all_finite(result));
  EXPECT_LT(pose_distance(result.T_camera_world[moving], T_true), 1e-3);
}

// A point so much too far that each step that depth asks for puts it behind its camera, until
// damping has grown too strong for any camera to move within the iterations there are: from 3 m,
// with an inverse depth of 1 / m, the linearised step leads to 2 * 3 - 3 * 3 = -3 m.
TEST(BundleAdjuster, OnePointThatAStepPutsBehindItsCameraDoesNotBlockTheOthers) {
  const BundleProblem truth = make_bundle({.seed = 27});
  BundleProblem problem = perturbed(truth, 28, 0.03);
  const std::uint32_t held = 0, point = static_cast<std::uint32_t>(problem.points.size());
  const Eigen::Vector2d px(300, 200);
  problem.points.push_back(problem.T_camera_world[held].inverse() *
                           problem.camera.unproject(px, 3.0));
  PointMeasurement m;
  m.px = px;
  m.inverse_depth = 1.0;
  m.inverse_depth_weight = 1.0 / kInverseDepthSigma;
  problem.observations.push_back({held, point, m});
  const BundleResult result = adjust_bundle(problem, {});
  EXPECT_TRUE(all_finite(result));
  for (std::size_t c = 0; c < truth.held.size(); ++c) {
    EXPECT_LT(pose_distance(result.T_camera_world[c], truth.T_camera_world[c]), 1e-4) << c;
  }
  for (std::size_t p = 0; p < truth.points.size(); ++p) {
    EXPECT_LT((result.points[p] - truth.points[p]).norm(), 1e-3) << p;
  }
  // Only that point's observation does not fit.
  EXPECT_EQ(std::accumulate(result.inlier.begin(), result.inlier.end(), std::size_t{0}),
            truth.observations.size());
  EXPECT_EQ(result.inlier.back(), 0);
}

TEST(BundleAdjuster, WithoutFreeCamerasPointsAloneMove) {
  const BundleProblem truth = make_bundle({.seed = 17});
  BundleProblem problem = perturbed(truth, 18, 0.03);
  problem.T_camera_world = truth.T_camera_world;
  problem.held.assign(problem.held.size(), 1);
  const BundleResult result = adjust_bundle(problem, kThorough);
  for (std::size_t p = 0; p < truth.points.size(); ++p) {
    EXPECT_LT((result.points[p] - truth.points[p]).norm(), 1e-5) << p;
  }
}

TEST(BundleAdjuster, DegenerateProblemsStayFinite) {
  EXPECT_TRUE(all_finite(adjust_bundle({}, {})));

  BundleProblem no_observations = make_bundle({.seed = 19, .noise = 1.0});
  no_observations.observations.clear();
  const BundleResult unchanged = adjust_bundle(no_observations, {});
  EXPECT_EQ(unchanged.points, no_observations.points);
  EXPECT_EQ(unchanged.final_cost, 0.0);

  // A point seen once, without depth; and a camera that sees one point only.
  BundleProblem once = perturbed(make_bundle({.seed = 20, .noise = 1.0}), 21, 0.01);
  std::erase_if(once.observations, [](const BundleObservation& o) {
    return (o.point == 8 && o.camera != 4) || (o.camera == 6 && o.point != 9);
  });
  for (BundleObservation& o : once.observations) {
    if (o.point == 8) o.measurement.inverse_depth = o.measurement.inverse_depth_weight = 0;
  }
  const BundleResult result = adjust_bundle(once, kThorough);
  EXPECT_TRUE(all_finite(result));
  EXPECT_LT(result.final_cost, result.initial_cost);

  // No camera held: the frame is free, the shape is not.
  BundleProblem free = perturbed(make_bundle({.seed = 22}), 23, 0.01);
  free.held.assign(free.held.size(), 0);
  const BundleResult floating = adjust_bundle(free, kThorough);
  EXPECT_TRUE(all_finite(floating));
  EXPECT_LT(floating.final_cost, 1e-6);
}

TEST(BundleAdjuster, OneValueThatIsNoNumberDoesNotSpoilTheRest) {
  BundleProblem truth = make_bundle({.seed = 24});
  BundleProblem problem = perturbed(truth, 25, 0.02);
  problem.observations[10].measurement.px.x() = std::numeric_limits<double>::quiet_NaN();
  const BundleResult result = adjust_bundle(problem, kThorough);
  EXPECT_TRUE(all_finite(result));
  EXPECT_EQ(result.inlier[10], 0);
  for (std::size_t c = 0; c < truth.held.size(); ++c) {
    EXPECT_LT(pose_distance(result.T_camera_world[c], truth.T_camera_world[c]), 1e-6) << c;
  }
}

}  // namespace
}  // namespace stillmap
