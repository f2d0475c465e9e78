// SPDX-License-Identifier: Apache-2.0
// Pose optimisation and bundle adjustment; the latter next to Ceres on the same problem, with the
// same loss and analytic derivatives, on one thread. `cost` shows that both reach the same minimum.
#include <array>

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

constexpr int kIterations = 10;
constexpr double kTolerance = 1e-5;  // relative decrease at which the adjuster stops

void pose_of_400_observations(benchmark::State& state) {
  PoseScene scene = make_pose_scene(1, 400, Depths::kSome, 1.0);
  for (std::size_t i = 0; i < 400; i += 10) scene.observations[i].measurement.px.x() += 50;
  TestRandom random(2);
  const Eigen::Isometry3d start = perturb_left(scene.T_camera_world, random.twist(0.02, 0.02));
  int inliers = 0;
  for (auto iteration : state) {
    inliers = optimize_pose(scene.camera, start, scene.observations).inliers;
  }
  state.counters["inliers"] = inliers;
}

BundleProblem bench_problem() {
  return perturbed(
      make_bundle({.seed = 1, .cameras = 20, .points = 2000, .seen = 0.44, .noise = 1.0}), 2, 0.02);
}

void bundle_ours(benchmark::State& state) {
  const BundleProblem problem = bench_problem();
  BundleResult result;
  for (auto iteration : state) {
    result = adjust_bundle(problem, {.robust_iterations = kIterations, .final_iterations = 0});
  }
  state.counters["cost"] = result.final_cost;
  state.counters["iterations"] = result.iterations;
  state.counters["observations"] = static_cast<double>(problem.observations.size());
}

/// A pose for Ceres: quaternion (x, y, z, w), then translation; steps are perturb_left's.
Eigen::Isometry3d pose_of(const double* x) {
  return make_pose(Eigen::Quaterniond(x[3], x[0], x[1], x[2]), {x[4], x[5], x[6]});
}

void store_pose(const Eigen::Isometry3d& T, double* x) {
  const Eigen::Quaterniond q(T.linear());
  Eigen::Map<Eigen::Vector4d>{x} = q.coeffs();
  Eigen::Map<Eigen::Vector3d>{x + 4} = T.translation();
}

/// Its derivative by the step is that of the cost alone, which gives it in the first six columns.
class PoseManifold : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 7; }
  [[nodiscard]] int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Vector6d step = Eigen::Map<const Vector6d>(delta);
    store_pose(perturb_left(pose_of(x), step), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>{jacobian}.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    const Eigen::Isometry3d between = pose_of(y) * pose_of(x).inverse();
    Eigen::Map<Eigen::Vector3d>{y_minus_x} = between.translation();
    Eigen::Map<Eigen::Vector3d>{y_minus_x + 3} = so3_log(Eigen::Quaterniond(between.linear()));
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>{jacobian}.setIdentity();
    return true;
  }
};

class AnalyticCost : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  AnalyticCost(const CameraModel& camera, const PointMeasurement& m) : camera_(camera), m_(m) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const Eigen::Isometry3d T = pose_of(x[0]);
    const Eigen::Vector3d p_camera = T * Eigen::Vector3d(x[1][0], x[1][1], x[1][2]);
    if (p_camera.z() < kMinPointDepth) return false;
    Eigen::Map<Eigen::Vector3d>{residual} = reprojection_residual(camera_, m_, p_camera);
    if (jacobians == nullptr) return true;
    const Eigen::Matrix3d J = reprojection_jacobian(camera_, m_, p_camera);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> J_pose(jacobians[0]);
      J_pose.leftCols<6>() = pose_jacobian(J, p_camera);
      J_pose.rightCols<1>().setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[1]} = J * T.linear();
    }
    return true;
  }

 private:
  const CameraModel& camera_;
  const PointMeasurement& m_;
};

ceres::Solver::Summary solve_with_ceres(const BundleProblem& bundle) {
  std::vector<std::array<double, 7>> poses(bundle.T_camera_world.size());
  std::vector<Eigen::Vector3d> points = bundle.points;
  ceres::Problem problem;
  ceres::Solver::Options options;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t c = 0; c < poses.size(); ++c) {
    store_pose(bundle.T_camera_world[c], poses[c].data());
    problem.AddParameterBlock(poses[c].data(), 7, new PoseManifold);
    options.linear_solver_ordering->AddElementToGroup(poses[c].data(), 1);
    if (bundle.held[c] != 0) problem.SetParameterBlockConstant(poses[c].data());
  }
  for (Eigen::Vector3d& p : points) {
    problem.AddParameterBlock(p.data(), 3);
    options.linear_solver_ordering->AddElementToGroup(p.data(), 0);
  }
  for (const BundleObservation& o : bundle.observations) {
    problem.AddResidualBlock(new AnalyticCost(bundle.camera, o.measurement),
                             new ceres::HuberLoss(std::sqrt(chi2_bound(o.measurement))),
                             poses[o.camera].data(),
                             points[o.point].data());
  }
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = kIterations;
  options.function_tolerance = kTolerance;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

void bundle_ceres(benchmark::State& state) {
  const BundleProblem problem = bench_problem();
  ceres::Solver::Summary summary;
  for (auto iteration : state) summary = solve_with_ceres(problem);
  state.counters["cost"] = 2 * summary.final_cost;
  state.counters["iterations"] = static_cast<double>(summary.iterations.size() - 1);
  state.counters["observations"] = static_cast<double>(problem.observations.size());
}

BENCHMARK(pose_of_400_observations)->Unit(benchmark::kMillisecond);
BENCHMARK(bundle_ours)->Unit(benchmark::kMillisecond);
BENCHMARK(bundle_ceres)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
