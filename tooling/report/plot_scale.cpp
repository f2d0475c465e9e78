// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/plot_scale.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

double nice_step(double width, int about) {
  const double raw = width / std::max(about, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  const double round = lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10;
  return round * power;
}

AxisScale widened(AxisScale axis, double units_per_px) {
  const double middle = 0.5 * (axis.low + axis.high);
  const double half = 0.5 * units_per_px * std::abs(axis.high_px - axis.low_px);
  axis.low = middle - half;
  axis.high = middle + half;
  return axis;
}

double units_per_px(const AxisScale& axis) {
  return (axis.high - axis.low) / std::abs(axis.high_px - axis.low_px);
}

}  // namespace

std::vector<double> nice_ticks(double low, double high, int about) {
  STILLMAP_CHECK(std::isfinite(low) && std::isfinite(high) && low < high);
  const double step = nice_step(high - low, about);
  const double slack = 1e-9;  // of a step: a tick that rounding puts just outside still counts
  std::vector<double> ticks;
  const double last = std::floor(high / step + slack);
  for (double i = std::ceil(low / step - slack); i <= last && ticks.size() < 100; i += 1) {
    ticks.push_back(i == 0 ? 0.0 : i * step);  // never -0
  }
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-6)), 0, 9);
  double largest = 0;
  for (const double tick : ticks) largest = std::max(largest, std::abs(tick));
  std::vector<std::string> labels;
  for (const double tick : ticks) {
    labels.push_back(largest >= 1e7 ? fmt::format("{:g}", tick)
                                    : fmt::format("{:.{}f}", tick, decimals));
  }
  return labels;
}

ValueRange ValueRange::padded(double share) const {
  if (empty) return {.low = 0, .high = 1, .empty = false};
  const double width = high - low;
  // A width that is negligible against the values cannot be divided into ticks.
  const double magnitude = std::max(std::abs(low), std::abs(high));
  const double pad = width > 1e-9 * magnitude ? share * width : std::max(0.5, 0.1 * magnitude);
  return {.low = low - pad, .high = high + pad, .empty = false};
}

PlotScale fit_scale(const ValueRange& x,
                    const ValueRange& y,
                    const Eigen::AlignedBox2d& box_px,
                    bool equal_axes) {
  PlotScale scale;
  scale.x = {x.low, x.high, box_px.min().x(), box_px.max().x()};
  scale.y = {y.low, y.high, box_px.max().y(), box_px.min().y()};
  if (equal_axes) {
    const double unit = std::max(units_per_px(scale.x), units_per_px(scale.y));
    scale.x = widened(scale.x, unit);
    scale.y = widened(scale.y, unit);
  }
  return scale;
}

}  // namespace stillmap
