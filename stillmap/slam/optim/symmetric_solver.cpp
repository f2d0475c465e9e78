// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/symmetric_solver.hpp"

#include <Eigen/Cholesky>

namespace stillmap {

Vector6d solve_symmetric(const Matrix6d& H, const Vector6d& b) {
  return H.ldlt().solve(b);
}

std::optional<Matrix6d> inverse_of_symmetric(const Matrix6d& H, double min_rcond) {
  const Eigen::LDLT<Matrix6d> factors(H);
  if (factors.info() != Eigen::Success || factors.rcond() < min_rcond) return std::nullopt;
  // Eigen's estimate of the condition number passes over pivots that are zero.
  if (!(factors.vectorD().minCoeff() > 0)) return std::nullopt;
  return factors.solve(Matrix6d::Identity());
}

}  // namespace stillmap
