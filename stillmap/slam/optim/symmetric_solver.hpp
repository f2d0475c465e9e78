// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

// The normal equations of a pose. Eigen's factorisation takes the compiler seconds in each file, so
// it stands in one.

/// The solution of H x = b by LDL^T for a positive definite `H`, of which the lower triangle is
/// read.
[[nodiscard]] Vector6d solve_symmetric(const Matrix6d& H, const Vector6d& b);

/// The inverse of a positive definite matrix, of which the lower triangle is read: the covariance
/// that the information `H` leaves. Nothing where `H` is not positive definite or its reciprocal
/// condition number is below `min_rcond`.
[[nodiscard]] std::optional<Matrix6d> inverse_of_symmetric(const Matrix6d& H, double min_rcond);

}  // namespace stillmap
