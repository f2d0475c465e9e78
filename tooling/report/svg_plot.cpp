// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/svg_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include "tooling/report/page_text.hpp"

namespace stillmap {
namespace {

constexpr double kLeft = 62, kRight = 16;  // margins, pixels
constexpr double kLargest = 1e12;

bool drawable(const Eigen::Vector2d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() < kLargest;
}

template <class... Args>
void append(std::string& out, fmt::format_string<Args...> format, Args&&... args) {
  out += fmt::format(format, std::forward<Args>(args)...);
}

std::string grid(const PlotScale& scale, const Plot& plot) {
  const double x_px = scale.x.high_px - scale.x.low_px;
  const double y_px = scale.y.low_px - scale.y.high_px;
  const std::vector<double> xs = nice_ticks(scale.x.low, scale.x.high, static_cast<int>(x_px / 80));
  const std::vector<double> ys = nice_ticks(scale.y.low, scale.y.high, static_cast<int>(y_px / 34));
  const std::vector<std::string> x_texts = tick_labels(xs);
  const std::vector<std::string> y_texts = tick_labels(ys);
  std::string out = "<g class=\"grid\">";
  for (const double x : xs) {
    append(out,
           "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>",
           scale.x.to_px(x),
           scale.y.low_px,
           scale.y.high_px);
  }
  for (const double y : ys) {
    append(out,
           "<path d=\"M{1:.1f} {0:.1f}H{2:.1f}\"/>",
           scale.y.to_px(y),
           scale.x.low_px,
           scale.x.high_px);
  }
  out += "</g>";
  for (std::size_t i = 0; i < xs.size(); ++i) {
    append(out,
           "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"mid\">{}</text>",
           scale.x.to_px(xs[i]),
           scale.y.low_px + 17,
           x_texts[i]);
  }
  for (std::size_t i = 0; i < ys.size(); ++i) {
    append(out,
           "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"end\">{}</text>",
           scale.x.low_px - 7,
           scale.y.to_px(ys[i]) + 4,
           y_texts[i]);
  }
  append(out,
         "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"mid label\">{}</text>",
         0.5 * (scale.x.low_px + scale.x.high_px),
         plot.height_px - 8.0,
         html_escape(plot.x_label));
  const double middle = 0.5 * (scale.y.low_px + scale.y.high_px);
  append(out,
         "<text x=\"15\" y=\"{0:.1f}\" class=\"mid label\" transform=\"rotate(-90 15 {0:.1f})\">"
         "{1}</text>",
         middle,
         html_escape(plot.y_label));
  return out;
}

// The path through the points, without those that are too close together to be seen apart.
std::string line_path(const PlotSeries& series, const PlotScale& scale) {
  constexpr double kVisible_px = 0.3;
  std::string out;
  bool down = false;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    if (!drawable(series.points[i])) {
      down = false;
      continue;
    }
    const Eigen::Vector2d px = scale.to_px(series.points[i]);
    const bool ends = i + 1 == series.points.size() || !drawable(series.points[i + 1]);
    if (down && !ends && (px - last).norm() < kVisible_px) continue;
    append(out, "{}{:.1f} {:.1f}", down ? 'L' : 'M', px.x(), px.y());
    if (!down && ends) out += "h0.1";  // a single point: round caps make it a dot
    last = px;
    down = true;
  }
  return out;
}

std::string series_svg(const PlotSeries& series, const PlotScale& scale) {
  std::string out;
  if (series.style == PlotStyle::kLine || series.style == PlotStyle::kDashed) {
    append(out,
           "<path class=\"line c{}{}\" d=\"{}\"/>",
           series.color,
           series.style == PlotStyle::kDashed ? " dashed" : "",
           line_path(series, scale));
    return out;
  }
  for (const Eigen::Vector2d& point : series.points) {
    if (!drawable(point)) continue;
    const Eigen::Vector2d px = scale.to_px(point);
    if (series.style == PlotStyle::kDots) {
      append(out,
             "<circle class=\"dot c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>",
             series.color,
             px.x(),
             px.y());
    } else {
      append(out,
             "<path class=\"line c{}\" d=\"M{:.1f} {:.1f}v-9\"/>",
             series.color,
             px.x(),
             scale.y.low_px);
    }
  }
  return out;
}

std::string legend(const Plot& plot) {
  std::string out;
  double x = kLeft;
  for (const PlotSeries& series : plot.series) {
    if (series.name.empty()) continue;
    if (series.style == PlotStyle::kDots) {
      append(
          out, "<circle class=\"dot c{}\" cx=\"{:.1f}\" cy=\"15\" r=\"4\"/>", series.color, x + 12);
    } else {
      const bool marks = series.style == PlotStyle::kMarks;
      append(out,
             "<path class=\"line c{}{}\" d=\"{}\"/>",
             series.color,
             series.style == PlotStyle::kDashed ? " dashed" : "",
             marks ? fmt::format("M{:.1f} 20v-9", x + 12) : fmt::format("M{:.1f} 15h24", x));
    }
    append(out, "<text x=\"{:.1f}\" y=\"19\">{}</text>", x + 31, html_escape(series.name));
    x += 31 + 6.3 * static_cast<double>(series.name.size()) + 18;  // 6.3 px: about a letter's width
  }
  return out;
}

bool has_points(const Plot& plot) {
  for (const PlotSeries& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (drawable(point)) return true;
    }
  }
  return false;
}

}  // namespace

PlotScale plot_scale(const Plot& plot) {
  ValueRange x;
  ValueRange y;
  for (const PlotSeries& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (!drawable(point)) continue;
      x.add(point.x());
      if (series.style != PlotStyle::kMarks) y.add(point.y());
    }
  }
  if (plot.y_from_zero) y.add(0);
  ValueRange y_padded = y.padded(0.06);
  if (plot.y_from_zero) y_padded.low = 0;
  const bool legend = std::any_of(
      plot.series.begin(), plot.series.end(), [](const PlotSeries& s) { return !s.name.empty(); });
  const double top = legend ? 34 : 12;
  const double bottom = plot.height_px - (plot.x_label.empty() ? 26 : 46);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(kLeft, top),
                                Eigen::Vector2d(plot.width_px - kRight, bottom));
  return fit_scale(x.padded(plot.equal_axes ? 0.06 : 0), y_padded, box, plot.equal_axes);
}

std::string plot_svg(const Plot& plot) {
  std::string out;
  append(out,
         "<div class=\"plot\"><svg viewBox=\"0 0 {0} {1}\" style=\"min-width:{2}px\" role=\"img\" "
         "aria-label=\"{3}\">",
         plot.width_px,
         plot.height_px,
         plot.width_px * 17 / 20,
         html_escape(plot.title));
  if (has_points(plot)) {
    const PlotScale scale = plot_scale(plot);
    out += grid(scale, plot);
    for (const PlotSeries& series : plot.series) out += series_svg(series, scale);
    out += legend(plot);
  } else {
    append(out,
           "<text x=\"{}\" y=\"{}\" class=\"mid\">nothing to show</text>",
           plot.width_px / 2,
           plot.height_px / 2);
  }
  return out + "</svg></div>";
}

}  // namespace stillmap
