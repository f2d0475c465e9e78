// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// The weight of a residual, given squared, under the Cauchy loss: small for large residuals.
[[nodiscard]] inline double cauchy_weight(double squared, double scale) {
  return 1.0 / (1.0 + squared / (scale * scale));
}

}  // namespace stillmap
