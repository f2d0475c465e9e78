// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace stillmap {

/// For tests: the derivative of `f` (a vector of any length) at `x` by central differences. Its
/// error, relative to the size of f, is about the square of `step` plus 1e-16 / `step`.
template <class Function>
[[nodiscard]] Eigen::MatrixXd numeric_jacobian(const Function& f,
                                               const Eigen::VectorXd& x,
                                               double step = 1e-6) {
  const Eigen::VectorXd at_x = f(x);
  Eigen::MatrixXd J(at_x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd above = x, below = x;
    above[i] += step;
    below[i] -= step;
    J.col(i) = (f(above) - f(below)) / (above[i] - below[i]);
  }
  return J;
}

}  // namespace stillmap
