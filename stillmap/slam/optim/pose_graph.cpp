// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_graph.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

#include "stillmap/core/error.hpp"
#include "stillmap/slam/optim/pose_residual.hpp"

namespace stillmap {
namespace {

// Ceres would report these on stderr and continue without a result.
void check(const PoseGraph& graph) {
  STILLMAP_CHECK(graph.held.size() == graph.T_world.size());
  const bool poses_finite = std::ranges::all_of(
      graph.T_world, [](const Eigen::Isometry3d& T) { return T.matrix().allFinite(); });
  const bool edges_finite = std::ranges::all_of(
      graph.edges, [](const PoseGraphEdge& edge) { return edge.T_from_to.matrix().allFinite(); });
  if (!poses_finite || !edges_finite) {
    throw Error("pose graph: a pose or an edge is not a finite number");
  }
  for (const PoseGraphEdge& edge : graph.edges) {
    STILLMAP_CHECK(edge.from < graph.T_world.size() && edge.to < graph.T_world.size());
    STILLMAP_CHECK(edge.from != edge.to && edge.sigma_m > 0 && edge.sigma_rad > 0);
  }
}

double chi2_of(const PoseGraphEdge& edge, const std::vector<PoseBlock>& poses) {
  std::array<double, 6> residual{};
  PoseResidual{edge}(poses[edge.from].data(), poses[edge.to].data(), residual.data());
  return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(residual.data()).squaredNorm();
}

double total(const std::vector<PoseGraphEdge>& edges, const std::vector<PoseBlock>& poses) {
  double sum = 0;
  for (const PoseGraphEdge& edge : edges) sum += chi2_of(edge, poses);
  return sum;
}

bool solve(const PoseGraph& graph, const PoseGraphConfig& config, std::vector<PoseBlock>& poses) {
  using Manifold =
      ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
  using Cost = ceres::AutoDiffCostFunction<PoseResidual, 6, 7, 7>;
  ceres::Problem problem;
  std::vector<std::uint8_t> used(poses.size(), 0);
  for (const PoseGraphEdge& edge : graph.edges) {
    problem.AddResidualBlock(
        new Cost(new PoseResidual(edge)), nullptr, poses[edge.from].data(), poses[edge.to].data());
    used[edge.from] = used[edge.to] = 1;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (used[i] == 0) continue;
    problem.SetManifold(poses[i].data(), new Manifold);
    if (graph.held[i] != 0) problem.SetParameterBlockConstant(poses[i].data());
  }
  ceres::Solver::Options options;
  // SuiteSparse would call a BLAS that may use threads. Eigen gives the same bits everywhere.
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = config.iterations;
  options.function_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace

PoseGraphResult optimize_pose_graph(const PoseGraph& graph, const PoseGraphConfig& config) {
  check(graph);
  std::vector<PoseBlock> poses;
  poses.reserve(graph.T_world.size());
  for (const Eigen::Isometry3d& T : graph.T_world) poses.push_back(pose_block(T));
  PoseGraphResult result;
  result.initial_cost = total(graph.edges, poses);
  result.converged = solve(graph, config, poses);
  result.final_cost = total(graph.edges, poses);
  for (const PoseGraphEdge& edge : graph.edges) result.chi2.push_back(chi2_of(edge, poses));
  // Poses that did not move keep their bits.
  for (std::size_t i = 0; i < poses.size(); ++i) {
    result.T_world.push_back(poses[i] == pose_block(graph.T_world[i]) ? graph.T_world[i]
                                                                      : pose_of(poses[i]));
  }
  return result;
}

}  // namespace stillmap
