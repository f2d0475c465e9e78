// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "stillmap/report/display_text.hpp"
#include "stillmap/report/page_sections.hpp"
#include "stillmap/report/page_text.hpp"
#include "stillmap/report/svg_plot.hpp"

namespace stillmap {
namespace {

constexpr int kEstimateColor = 0, kTruthColor = 1, kKeyframeColor = 4, kLostColor = 3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Place {
  double t_s;  // since the run's first frame
  Eigen::Vector3d p_world;
};

// Places in time with one that is not finite, where plots lift the pen, in gaps of over half a
// second.
std::vector<Place> places(const Trajectory& poses, double start_s) {
  std::vector<Place> out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = poses[i].stamp.seconds - start_s;
    if (i > 0 && poses[i].stamp.seconds - poses[i - 1].stamp.seconds > 0.5) {
      out.push_back({kNan, Eigen::Vector3d::Constant(kNan)});
    }
    out.push_back({t, poses[i].T_world_camera.translation()});
  }
  return out;
}

// The ground truth in the run's world, while the run lasted. Empty where nothing aligns them.
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

}  // namespace

std::string trajectory_html(const RunReport& report) {
  if (report.estimate.empty()) return "<p>No frame was tracked, so there is no trajectory.</p>";
  const double start = first_stamp_s(report);
  const std::vector<Place> estimate = places(report.estimate, start);
  const std::vector<Place> truth = places(aligned_truth(report), start);
  const std::vector<Place> keyframes = places(report.keyframes, start);
  Plot above{.title = "Trajectory from above",
             .x_label = "x (m)",
             .y_label = "z (m)",
             .series = {},
             .width_px = 520,
             .height_px = 540,
             .equal_axes = true};
  if (!truth.empty()) {
    above.series.push_back(from_above("ground truth", truth, kTruthColor, PlotStyle::kDashed));
  }
  above.series.push_back(from_above("estimate", estimate, kEstimateColor, PlotStyle::kLine));
  above.series.push_back(from_above("key frames", keyframes, kKeyframeColor, PlotStyle::kDots));

  std::string beside;
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const char* const name = kAxes[static_cast<std::size_t>(axis)];
    Plot plot{.title = fmt::format("{} over time", name),
              .x_label = axis == 2 ? "time (s)" : "",
              .y_label = fmt::format("{} (m)", name),
              .series = {},
              .width_px = 520,
              .height_px = 180};
    const bool named = axis == 0;
    if (!truth.empty()) {
      plot.series.push_back(
          over_time(named ? "ground truth" : "", truth, axis, kTruthColor, PlotStyle::kDashed));
    }
    plot.series.push_back(
        over_time(named ? "estimate" : "", estimate, axis, kEstimateColor, PlotStyle::kLine));
    add_lost_marks(plot, report, named);
    beside += plot_svg(plot);
  }
  return fmt::format(
      "{}<div class=\"columns\"><div><h3>From above</h3>{}</div><div><h3>Over "
      "time</h3>{}</div></div>",
      note_html(report),
      plot_svg(above),
      beside);
}

std::string error_html(const RunReport& report) {
  if (!report.ate) {
    return report.groundtruth
               ? "<p>The ground truth has fewer than three poses in common with the run.</p>"
               : "<p>There is no ground truth, so the error is not known.</p>";
  }
  const double largest = report.ate->translation_m.max;
  const double per_metre = largest < 0.02 ? 1000 : largest < 2 ? 100 : 1;
  const char* const unit = largest < 0.02 ? "mm" : largest < 2 ? "cm" : "m";
  const double start = first_stamp_s(report);
  PlotSeries error{.name = "distance to ground truth", .points = {}, .color = kEstimateColor};
  double last = kNan;
  for (const AtePair& pair : report.ate->pairs) {
    const double t = pair.stamp.seconds - start;
    if (t - last > 0.5) error.points.emplace_back(kNan, kNan);
    error.points.emplace_back(t, pair.error_m * per_metre);
    last = t;
  }
  Plot plot{.title = "Error over time",
            .x_label = "time (s)",
            .y_label = fmt::format("error ({})", unit),
            .series = {std::move(error)},
            .y_from_zero = true};
  if (!report.ate->pairs.empty()) {
    const double rmse = report.ate->translation_m.rmse * per_metre;
    const double end = report.ate->pairs.back().stamp.seconds - start;
    plot.series.push_back(
        {.name = "rmse",
         .points = {{report.ate->pairs.front().stamp.seconds - start, rmse}, {end, rmse}},
         .color = kLostColor,
         .style = PlotStyle::kDashed});
  }
  add_lost_marks(plot, report, true);
  return fmt::format(
      "<p class=\"note\">Residuals of {} pairs of poses after the alignment: mean {}, "
      "standard deviation {}.</p>{}",
      count_text(report.ate->pairs.size()),
      length_text(report.ate->translation_m.mean),
      length_text(report.ate->translation_m.std),
      plot_svg(plot));
}

}  // namespace stillmap
