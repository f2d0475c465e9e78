// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/symmetric_solver.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// J^T J of a fixed J: positive definite.
Matrix6d information() {
  Matrix6d J = Matrix6d::Identity();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) J(i, j) = 0.1 * (i + 2 * j) - 0.3;
  }
  return J.transpose() * J;
}

TEST(SymmetricSolver, ReadsTheLowerTriangleAlone) {
  const Matrix6d H = information();
  const Vector6d x = (Vector6d() << 1, -2, 3, -4, 5, -6).finished();
  EXPECT_LT((solve_symmetric(H, H * x) - x).norm(), 1e-10);
  const Matrix6d lower = H.triangularView<Eigen::Lower>();
  EXPECT_EQ(solve_symmetric(lower, H * x), solve_symmetric(H, H * x));
}

TEST(SymmetricSolver, InvertsWhatHasAnInverse) {
  const Matrix6d H = information();
  const std::optional<Matrix6d> inverse = inverse_of_symmetric(H, 1e-12);
  ASSERT_TRUE(inverse);
  EXPECT_LT((H * *inverse - Matrix6d::Identity()).norm(), 1e-10);
  Matrix6d flat = H;
  flat.row(5).setZero();
  flat.col(5).setZero();
  EXPECT_FALSE(inverse_of_symmetric(flat, 1e-12));
}

}  // namespace
}  // namespace stillmap
