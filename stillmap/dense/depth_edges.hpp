// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"

namespace stillmap {

struct DepthEdgesConfig {
  double step_m = 0.1;
  double step_per_m = 0.01;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("step_m",
          self.step_m,
          FieldInfo{
              "depth difference of neighbours that makes an edge (tau3 of Fan 2020)", "m", 0, 100});
    visit("step_per_m",
          self.step_per_m,
          FieldInfo{"growing: least depth difference at an edge, per depth squared", "1/m", 0, 10});
  }
};

/// A copy of a depth image (metres) without its discontinuities (Fan 2020, Eqs. (11)-(12)).
///
/// In each window of 2 by 2 pixels, the upper left one becomes 0 when the window's greatest and
/// least depth differ by more than max(step_m, step_per_m z^2), z being the least. Missing depth
/// (0, negative, not finite) is no discontinuity, and neither is what lies beyond the image.
/// Neighbours in a row or a column that both are left differ by no more than that.
///
/// The paper's threshold is fixed: step_per_m = 0. But the noise of a structured-light camera grows
/// with depth squared, so that a fixed one takes the farther walls apart.
[[nodiscard]] cv::Mat1f without_edges(const cv::Mat1f& depth, const DepthEdgesConfig& config);

}  // namespace stillmap
