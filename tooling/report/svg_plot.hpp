// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "tooling/report/plot_scale.hpp"

namespace stillmap {

enum class PlotStyle { kLine, kDashed, kDots, kMarks };  ///< kMarks: short ticks on the x axis

struct PlotSeries {
  std::string name;  ///< in the legend; none when empty
  /// A point that is not finite, or beyond 1e12, is not drawn and breaks a line.
  std::vector<Eigen::Vector2d> points;
  int color = 0;  ///< of the page's eight colours: classes c0 to c7
  PlotStyle style = PlotStyle::kLine;
};

struct Plot {
  std::string title;  ///< said to screen readers
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;  ///< later ones are drawn on top
  int width_px = 1040;
  int height_px = 260;
  bool equal_axes = false;   ///< a unit has the same length on both axes
  bool y_from_zero = false;  ///< the y axis starts at 0 (values are not negative)
};

/// The scale from the plot's values to pixels of its picture.
[[nodiscard]] PlotScale plot_scale(const Plot& plot);

/// The plot as an SVG element for an HTML page; colours and fonts come from the page's style sheet.
/// A plot without points says so. All texts are escaped.
[[nodiscard]] std::string plot_svg(const Plot& plot);

}  // namespace stillmap
