// SPDX-License-Identifier: Apache-2.0
// The bundle adjuster against other ways to the same answers: Ceres, and a dense solve.
#include <Eigen/Cholesky>
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

/// The residual, written anew on a quaternion and a translation.
struct ReprojectionCost {
  CameraModel camera;
  PointMeasurement m;

  template <class T>
  bool operator()(const T* q, const T* t, const T* p, T* residual) const {
    const Eigen::Quaternion<T> rotation(q[3], q[0], q[1], q[2]);
    const Eigen::Matrix<T, 3, 1> x = rotation * Eigen::Matrix<T, 3, 1>(p[0], p[1], p[2]) +
                                     Eigen::Matrix<T, 3, 1>(t[0], t[1], t[2]);
    residual[0] = (x[0] / x[2] * camera.fx + camera.cx - m.px.x()) * m.pixel_weight;
    residual[1] = (x[1] / x[2] * camera.fy + camera.cy - m.px.y()) * m.pixel_weight;
    residual[2] = (1.0 / x[2] - m.inverse_depth) * m.inverse_depth_weight;
    return true;
  }
};

struct CeresSolution {
  std::vector<Eigen::Isometry3d> T_camera_world;
  std::vector<Eigen::Vector3d> points;
  double cost = 0;
};

void add_observation(const CameraModel& camera,
                     const BundleObservation& o,
                     std::vector<Eigen::Quaterniond>& rotations,
                     CeresSolution& solution,
                     std::vector<Eigen::Vector3d>& translations,
                     ceres::Problem& problem) {
  const double bound = std::sqrt(o.measurement.has_depth() ? 7.815 : 5.991);
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ReprojectionCost, 3, 4, 3, 3>(
                               new ReprojectionCost{camera, o.measurement}),
                           new ceres::HuberLoss(bound),
                           rotations[o.camera].coeffs().data(),
                           translations[o.camera].data(),
                           solution.points[o.point].data());
}

CeresSolution solve_with_ceres(const BundleProblem& bundle) {
  CeresSolution solution{bundle.T_camera_world, bundle.points, 0};
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Vector3d> translations;
  for (const Eigen::Isometry3d& T : bundle.T_camera_world) {
    rotations.emplace_back(T.linear());
    translations.emplace_back(T.translation());
  }
  ceres::Problem problem;
  for (const BundleObservation& o : bundle.observations) {
    add_observation(bundle.camera, o, rotations, solution, translations, problem);
  }
  for (std::size_t c = 0; c < rotations.size(); ++c) {
    problem.SetManifold(rotations[c].coeffs().data(), new ceres::EigenQuaternionManifold);
    if (bundle.held[c] == 0) continue;
    problem.SetParameterBlockConstant(rotations[c].coeffs().data());
    problem.SetParameterBlockConstant(translations[c].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t c = 0; c < rotations.size(); ++c) {
    solution.T_camera_world[c] = make_pose(rotations[c], translations[c]);
  }
  solution.cost = 2 * summary.final_cost;  // Ceres minimises half the sum
  return solution;
}

/// Without the second phase all observations stay in, as with Ceres.
constexpr BundleConfig kAllIn{.robust_iterations = 100, .final_iterations = 0};

// The solver stops at a relative decrease of 1e-5; starting again where it stopped goes further.
BundleProblem continued(BundleProblem problem, const BundleResult& result) {
  problem.T_camera_world = result.T_camera_world;
  problem.points = result.points;
  return problem;
}

TEST(BundleReference, SameOptimumAsCeres) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const BundleProblem problem =
        perturbed(make_bundle({.seed = seed, .seen = 0.7, .noise = 1.0}), seed + 30, 0.02);
    const BundleResult once = adjust_bundle(problem, kAllIn);
    const BundleResult ours = adjust_bundle(continued(problem, once), kAllIn);
    const CeresSolution theirs = solve_with_ceres(problem);
    EXPECT_NEAR(once.final_cost, theirs.cost, 1e-4 * theirs.cost) << seed;
    EXPECT_NEAR(ours.final_cost, theirs.cost, 1e-6 * theirs.cost) << seed;
    for (std::size_t c = 0; c < problem.held.size(); ++c) {
      EXPECT_LT(pose_distance(ours.T_camera_world[c], theirs.T_camera_world[c]), 1e-5) << c;
    }
  }
}

TEST(BundleReference, SecondPhaseIsTheOptimumOverTheInliers) {
  BundleProblem problem = make_bundle({.seed = 6, .seen = 0.7, .noise = 1.0});
  for (std::size_t i = 0; i < problem.observations.size(); i += 23) {
    problem.observations[i].measurement.px.x() += 25;
  }
  const BundleResult start =
      adjust_bundle(perturbed(problem, 36, 0.02), {.robust_iterations = 50, .final_iterations = 0});
  const BundleResult ours = adjust_bundle(perturbed(problem, 36, 0.02),
                                          {.robust_iterations = 50, .final_iterations = 50});
  BundleProblem inliers = problem;
  inliers.T_camera_world = start.T_camera_world;
  inliers.points = start.points;
  inliers.observations.clear();
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (start.inlier[i] != 0) inliers.observations.push_back(problem.observations[i]);
  }
  ASSERT_LT(inliers.observations.size(), 0.96 * static_cast<double>(problem.observations.size()));
  const CeresSolution theirs = solve_with_ceres(inliers);
  for (std::size_t c = 0; c < problem.held.size(); ++c) {
    EXPECT_LT(pose_distance(ours.T_camera_world[c], theirs.T_camera_world[c]), 1e-5) << c;
  }
}

/// All unknowns of a problem in one vector: steps of the free poses, then of the points.
class DenseProblem {
 public:
  explicit DenseProblem(const BundleProblem& problem) : problem_(problem) {
    for (std::size_t c = 0; c < problem.held.size(); ++c) {
      column_.push_back(cameras_);
      if (problem.held[c] == 0) cameras_ += 6;
    }
  }

  [[nodiscard]] Eigen::Index unknowns() const { return cameras_ + 3 * std::ssize(problem_.points); }
  [[nodiscard]] BundleProblem at(const Eigen::VectorXd& step) const {
    BundleProblem there = problem_;
    for (std::size_t c = 0; c < there.held.size(); ++c) {
      if (there.held[c] != 0) continue;
      there.T_camera_world[c] = perturb_left(there.T_camera_world[c], step.segment<6>(column_[c]));
    }
    for (std::size_t p = 0; p < there.points.size(); ++p) {
      there.points[p] += step.segment<3>(cameras_ + 3 * static_cast<Eigen::Index>(p));
    }
    return there;
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& step) const {
    const BundleProblem there = at(step);
    Eigen::VectorXd r(3 * std::ssize(there.observations));
    for (std::size_t i = 0; i < there.observations.size(); ++i) {
      const BundleObservation& o = there.observations[i];
      r.segment<3>(static_cast<Eigen::Index>(3 * i)) = reprojection_residual(
          there.camera, o.measurement, there.T_camera_world[o.camera] * there.points[o.point]);
    }
    return r;
  }

 private:
  const BundleProblem& problem_;
  std::vector<Eigen::Index> column_;
  Eigen::Index cameras_ = 0;
};

// The step is that of Levenberg-Marquardt with the full normal equations of numeric derivatives.
TEST(BundleReference, FirstStepEqualsADenseSolveOfTheFullNormalEquations) {
  constexpr double kFirstDamping = 1e-4;  // the solver's own, with 1e-9 for what has no data
  const BundleProblem problem = perturbed(
      make_bundle({.seed = 7, .cameras = 4, .points = 12, .seen = 0.8, .noise = 1.0}), 8, 0.01);
  const DenseProblem dense(problem);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(dense.unknowns());
  Eigen::VectorXd r = dense.residuals(zero);
  Eigen::MatrixXd J = numeric_jacobian([&](const auto& x) { return dense.residuals(x); }, zero);
  for (Eigen::Index i = 0; i < r.size(); i += 3) {
    const PointMeasurement& m = problem.observations[static_cast<std::size_t>(i / 3)].measurement;
    const double norm = r.segment<3>(i).norm(), bound = std::sqrt(m.has_depth() ? 7.815 : 5.991);
    const double root_weight = norm > bound ? std::sqrt(bound / norm) : 1.0;
    r.segment<3>(i) *= root_weight;
    J.middleRows<3>(i) *= root_weight;
  }
  Eigen::MatrixXd H = J.transpose() * J;
  H.diagonal() *= 1 + kFirstDamping;
  H.diagonal().array() += 1e-9;
  const Eigen::VectorXd step = H.llt().solve(-J.transpose() * r);

  const BundleProblem expected = dense.at(step);
  const BundleResult ours = adjust_bundle(problem, {.robust_iterations = 1, .final_iterations = 0});
  ASSERT_LT(ours.final_cost, ours.initial_cost);
  ASSERT_GT(step.cwiseAbs().maxCoeff(), 1e-3);
  for (std::size_t c = 0; c < problem.held.size(); ++c) {
    EXPECT_LT(pose_distance(ours.T_camera_world[c], expected.T_camera_world[c]), 1e-7) << c;
  }
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    EXPECT_LT((ours.points[p] - expected.points[p]).norm(), 1e-7) << p;
  }
}

}  // namespace
}  // namespace stillmap
