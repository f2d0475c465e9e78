// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace stillmap {

/// Round numbers (1, 2 or 5 times a power of ten apart) in [low, high], ascending, `about` of them
/// give or take a few. Needs low < high, both finite.
[[nodiscard]] std::vector<double> nice_ticks(double low, double high, int about);

/// The numbers as text, with as many decimals as needed to distinguish them.
[[nodiscard]] std::vector<std::string> tick_labels(const std::vector<double>& ticks);

/// A linear map from values to pixels along one axis.
struct AxisScale {
  double low = 0, high = 1;        ///< values at the ends of the axis
  double low_px = 0, high_px = 1;  ///< positions of these ends

  [[nodiscard]] double to_px(double value) const {
    return low_px + (value - low) / (high - low) * (high_px - low_px);
  }
};

/// Maps a plot's values to pixels of its picture; y goes up.
struct PlotScale {
  AxisScale x, y;
  [[nodiscard]] Eigen::Vector2d to_px(const Eigen::Vector2d& value) const {
    return {x.to_px(value.x()), y.to_px(value.y())};
  }
};

/// The smallest range that holds all added values.
struct ValueRange {
  double low = 0, high = 0;
  bool empty = true;

  void add(double value) {
    low = empty || value < low ? value : low;
    high = empty || value > high ? value : high;
    empty = false;
  }
  /// The range extended by a share of its width at each end; never of zero width.
  [[nodiscard]] ValueRange padded(double share) const;
};

/// The scale that shows x and y in a box of pixels. With `equal_axes` a unit is as long on both
/// axes, and one of the ranges grows about its middle.
[[nodiscard]] PlotScale fit_scale(const ValueRange& x,
                                  const ValueRange& y,
                                  const Eigen::AlignedBox2d& box_px,
                                  bool equal_axes);

}  // namespace stillmap
