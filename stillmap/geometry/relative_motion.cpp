// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/relative_motion.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "stillmap/geometry/cauchy.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

using Matrix26d = Eigen::Matrix<double, 2, 6>;

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
};

NormalEquations linearize(const CameraModel& camera,
                          std::span<const PointMatch> matches,
                          const Eigen::Isometry3d& T,
                          double scale_px) {
  NormalEquations sum;
  for (const PointMatch& match : matches) {
    if (!(match.previous_depth_m > 0)) continue;
    const Eigen::Vector3d p = T * camera.unproject(match.previous_px, match.previous_depth_m);
    if (!(p.z() > 1e-3)) continue;
    const Eigen::Vector2d r = camera.project(p) - match.current_px;
    const double iz = 1.0 / p.z();
    Eigen::Matrix<double, 2, 3> d_px;
    d_px << camera.fx * iz, 0, -camera.fx * p.x() * iz * iz, 0, camera.fy * iz,
        -camera.fy * p.y() * iz * iz;
    Matrix26d J;
    J << d_px, -d_px * skew(p);
    const double weight = cauchy_weight(r.squaredNorm(), scale_px);
    sum.H += weight * J.transpose() * J;
    sum.b -= weight * J.transpose() * r;
  }
  return sum;
}

}  // namespace

std::optional<Eigen::Isometry3d> relative_motion(
    const CameraModel& camera,
    std::span<const PointMatch> matches,
    const Eigen::Isometry3d& initial_T_current_previous,
    int min_matches) {
  int with_depth = 0;
  for (const PointMatch& match : matches) with_depth += match.previous_depth_m > 0 ? 1 : 0;
  if (with_depth < std::max(min_matches, 3)) return std::nullopt;
  Eigen::Isometry3d T = initial_T_current_previous;
  // From a loss that reaches far to one that counts only what fits.
  for (const double scale_px : {20.0, 8.0, 3.0, 1.5, 1.5, 1.5}) {
    const NormalEquations sum = linearize(camera, matches, T, scale_px);
    const Eigen::LDLT<Matrix6d> solver(sum.H);
    const Vector6d step = solver.solve(sum.b);
    if (solver.info() != Eigen::Success || !step.allFinite()) return std::nullopt;
    T = perturb_left(T, step);
  }
  return T;
}

}  // namespace stillmap
