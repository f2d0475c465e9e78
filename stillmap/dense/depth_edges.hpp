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

/// A copy of a depth image (metres) without its edges, after Fan 2020, section III-D, Eqs.
/// (11)-(12).
///
/// In each window of 2 by 2 pixels, the upper left pixel becomes 0 when the greatest and the least
/// depth of the window differ by more than max(step_m, step_per_m z^2), where z is the least.
/// Missing depth (0, negative, not finite) and the border of the image make no edge. Two neighbours
/// in a row or a column that both remain differ by no more than that.
///
/// The threshold grows because the noise of a structured-light camera grows with depth squared: a
/// fixed one removes pixels of far walls.
[[nodiscard]] cv::Mat1f without_edges(const cv::Mat1f& depth, const DepthEdgesConfig& config);

/// The same as Fan 2020 has it: the threshold is `step_m` at every depth, and missing depth, which
/// must be 0, counts as depth 0. So the upper left pixel of a window becomes 0 wherever depth
/// begins or ends, too. Windows are wholly inside the image.
[[nodiscard]] cv::Mat1f without_fixed_edges(const cv::Mat1f& depth, double step_m);

}  // namespace stillmap
