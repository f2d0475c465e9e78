// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"

namespace stillmap {

/// A measured relative pose with its standard deviations.
struct PoseGraphEdge {
  std::uint32_t from = 0;  ///< index of a pose
  std::uint32_t to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  double sigma_m = 0.01;
  double sigma_rad = 0.01;
};

struct PoseGraph {
  std::vector<Eigen::Isometry3d> T_world;  ///< initial poses
  std::vector<std::uint8_t> held;          ///< per pose; at least one in each connected component
  std::vector<PoseGraphEdge> edges;
};

struct PoseGraphConfig {
  int iterations = 50;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("iterations",
          self.iterations,
          FieldInfo{"greatest number of iterations of the pose graph", "", 1, 1000});
  }
};

struct PoseGraphResult {
  std::vector<Eigen::Isometry3d> T_world;
  std::vector<double> chi2;  ///< per edge: squared error in sigmas, 6 degrees of freedom
  double initial_cost = 0;   ///< sum of chi2 before optimisation
  double final_cost = 0;     ///< sum of chi2 after optimisation; never more
  bool converged = false;    ///< within the number of iterations
};

/// The poses that fit all edges best: least squares over SE(3) by Levenberg-Marquardt (Ceres), on
/// one thread and without time limits, so that equal input gives equal bits. A connected
/// component without a held pose stays unchanged if its edges already fit. Throws Error when a
/// number in the graph is not finite.
[[nodiscard]] PoseGraphResult optimize_pose_graph(const PoseGraph& graph,
                                                  const PoseGraphConfig& config);

}  // namespace stillmap
