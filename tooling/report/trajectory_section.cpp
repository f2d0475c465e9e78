// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <fmt/core.h>

#include "tooling/report/display_text.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/svg_plot.hpp"

namespace stillmap {
namespace {

constexpr int kEstimateColor = 0, kTruthColor = 1, kKeyframeColor = 4, kLostColor = 3;
constexpr double kGap_s = 0.5;  // longer gaps are left open in plots
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Place {
  double t_s;  // since the run's first frame
  Eigen::Vector3d p_world;
};

// Positions over time, with a non-finite one in each gap of over half a second, where plots break
// the line.
std::vector<Place> places(const Trajectory& poses, double start_s) {
  std::vector<Place> out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = poses[i].stamp.seconds - start_s;
    if (i > 0 && poses[i].stamp.seconds - poses[i - 1].stamp.seconds > kGap_s) {
      out.push_back({kNan, Eigen::Vector3d::Constant(kNan)});
    }
    out.push_back({t, poses[i].T_world_camera.translation()});
  }
  return out;
}

// The ground truth in the run's world frame, during the run. Empty if it cannot be aligned.
Trajectory aligned_truth(const RunReport& report) {
  Trajectory truth;
  if (!report.groundtruth || !report.ate || report.estimate.empty()) return truth;
  constexpr double kMargin_s = 0.05;
  const double from = report.estimate.front().stamp.seconds - kMargin_s;
  const double to = report.estimate.back().stamp.seconds + kMargin_s;
  for (const StampedPose& pose : *report.groundtruth) {
    if (pose.stamp.seconds < from || pose.stamp.seconds > to) continue;
    truth.push_back(
        {pose.stamp, report.ate->T_groundtruth_estimate.inverse() * pose.T_world_camera});
  }
  return truth;
}

PlotSeries from_above(std::string name,
                      const std::vector<Place>& path,
                      int color,
                      PlotStyle style) {
  PlotSeries series{.name = std::move(name), .points = {}, .color = color, .style = style};
  for (const Place& place : path) series.points.emplace_back(place.p_world.x(), place.p_world.z());
  return series;
}

PlotSeries over_time(
    std::string name, const std::vector<Place>& path, int axis, int color, PlotStyle style) {
  PlotSeries series{.name = std::move(name), .points = {}, .color = color, .style = style};
  for (const Place& place : path) series.points.emplace_back(place.t_s, place.p_world[axis]);
  return series;
}

void add_lost_marks(Plot& plot, const RunReport& report, bool named) {
  if (report.lost.empty()) return;
  PlotSeries marks{.name = named ? "no pose" : "",
                   .points = {},
                   .color = kLostColor,
                   .style = PlotStyle::kMarks};
  const double start = first_stamp_s(report);
  for (const Stamp& stamp : report.lost) marks.points.emplace_back(stamp.seconds - start, 0.0);
  plot.series.push_back(std::move(marks));
}

std::string note_html(const RunReport& report) {
  if (report.ate) {
    return "<p class=\"note\">In the run's world, whose origin is the first tracked camera: x to "
           "its right, "
           "y down, z ahead. The ground truth is moved to fit the estimate, without scale.</p>";
  }
  return fmt::format(
      "<p class=\"note\">In the run's world, whose origin is the first tracked camera: x to its "
      "right, y down, z ahead. {}</p>",
      report.groundtruth
          ? "The ground truth has too few poses in common with the run to be shown with it."
          : "There is no ground truth to compare with.");
}

struct Paths {
  std::vector<Place> estimate, keyframes, truth;
};

Paths paths_of(const RunReport& report) {
  const double start = first_stamp_s(report);
  return {places(report.estimate, start),
          places(report.keyframes, start),
          places(aligned_truth(report), start)};
}

Plot plot_from_above(const Paths& paths) {
  Plot plot{.title = "Trajectory from above",
            .x_label = "x (m)",
            .y_label = "z (m)",
            .series = {},
            .width_px = 520,
            .height_px = 528,
            .equal_axes = true};
  if (!paths.truth.empty()) {
    plot.series.push_back(from_above("ground truth", paths.truth, kTruthColor, PlotStyle::kDashed));
  }
  plot.series.push_back(from_above("estimate", paths.estimate, kEstimateColor, PlotStyle::kLine));
  plot.series.push_back(
      from_above("key frames", paths.keyframes, kKeyframeColor, PlotStyle::kDots));
  return plot;
}

// The three plots are stacked: the first has the legend, the last the label of time.
Plot plot_of_axis(const RunReport& report, const Paths& paths, int axis) {
  const char name = "xyz"[axis];
  const bool first = axis == 0;
  const bool last = axis == 2;
  Plot plot{.title = fmt::format("{} over time", name),
            .x_label = last ? "time (s)" : "",
            .y_label = fmt::format("{} (m)", name),
            .series = {},
            .width_px = 520,
            .height_px = last ? 184 : 172};
  if (!paths.truth.empty()) {
    plot.series.push_back(
        over_time(first ? "ground truth" : "", paths.truth, axis, kTruthColor, PlotStyle::kDashed));
  }
  plot.series.push_back(
      over_time(first ? "estimate" : "", paths.estimate, axis, kEstimateColor, PlotStyle::kLine));
  add_lost_marks(plot, report, first);
  return plot;
}

// The residuals in a unit that suits the largest, with the line broken at gaps.
struct ErrorCurve {
  const char* unit = "m";
  double per_metre = 1;
  std::vector<Eigen::Vector2d> points;
};

ErrorCurve error_curve(const AteResult& ate, double start_s) {
  ErrorCurve curve;
  const double largest = ate.translation_m.max;
  if (largest < 0.02) {
    curve = {"mm", 1000, {}};
  } else if (largest < 2) {
    curve = {"cm", 100, {}};
  }
  double last = kNan;
  for (const AtePair& pair : ate.pairs) {
    const double t = pair.stamp.seconds - start_s;
    if (t - last > kGap_s) curve.points.emplace_back(kNan, kNan);
    curve.points.emplace_back(t, pair.error_m * curve.per_metre);
    last = t;
  }
  return curve;
}

}  // namespace

std::string trajectory_html(const RunReport& report) {
  if (report.estimate.empty()) return "<p>No frame was tracked, so there is no trajectory.</p>";
  const Paths paths = paths_of(report);
  std::string over_time_plots;
  for (int axis = 0; axis < 3; ++axis)
    over_time_plots += plot_svg(plot_of_axis(report, paths, axis));
  return fmt::format(
      "{}<div class=\"columns\"><div><h3>From above</h3>{}</div><div><h3>Over "
      "time</h3>{}</div></div>",
      note_html(report),
      plot_svg(plot_from_above(paths)),
      over_time_plots);
}

std::string error_html(const RunReport& report) {
  if (!report.ate) {
    return report.groundtruth
               ? "<p>The ground truth has fewer than three poses in common with the run.</p>"
               : "<p>There is no ground truth, so the error is not known.</p>";
  }
  const Statistics& statistics = report.ate->translation_m;
  const ErrorCurve curve = error_curve(*report.ate, first_stamp_s(report));
  Plot plot{.title = "Error over time",
            .x_label = "time (s)",
            .y_label = fmt::format("error ({})", curve.unit),
            .series = {{.name = "distance to ground truth",
                        .points = curve.points,
                        .color = kEstimateColor}},
            .y_from_zero = true};
  if (!curve.points.empty()) {
    const double rmse = statistics.rmse * curve.per_metre;
    plot.series.push_back(
        {.name = "rmse",
         .points = {{curve.points.front().x(), rmse}, {curve.points.back().x(), rmse}},
         .color = kLostColor,
         .style = PlotStyle::kDashed});
  }
  add_lost_marks(plot, report, true);
  return fmt::format(
      "<p class=\"note\">Residuals of {} pairs of poses after the alignment: mean {}, "
      "standard deviation {}.</p>{}",
      count_text(report.ate->pairs.size()),
      length_text(statistics.mean),
      length_text(statistics.std),
      plot_svg(plot));
}

}  // namespace stillmap
