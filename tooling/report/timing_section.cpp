// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/core.h>

#include "tooling/report/display_text.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/page_text.hpp"
#include "tooling/report/svg_plot.hpp"
#include "tooling/report/time_summary.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kColors = 8;

PlotSeries by_frame(std::string name, const std::vector<double>& values, int color) {
  PlotSeries series{.name = std::move(name), .points = {}, .color = color};
  for (std::size_t i = 0; i < values.size(); ++i) {
    series.points.emplace_back(static_cast<double>(i), values[i]);
  }
  return series;
}

double total_ms(const StageTimes& stage) {
  return std::accumulate(stage.ms.begin(), stage.ms.end(), 0.0);
}

double total_ms(const std::vector<StageTimes>& stages) {
  double total = 0;
  for (const StageTimes& stage : stages) total += total_ms(stage);
  return total;
}

std::string bar_html(const std::vector<StageTimes>& stages, double total) {
  if (!(total > 0)) return "";
  std::string out = "<div class=\"bar\" role=\"img\" aria-label=\"Share of each stage\">";
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double percent = 100 * total_ms(stages[i]) / total;
    out += fmt::format(
        "<span class=\"key c{}\" style=\"flex:{:.4f} 0 0\" title=\"{}: {:.1f} %\"></span>",
        i % kColors,
        percent,
        html_escape(stages[i].name),
        percent);
  }
  return out + "</div>";
}

std::string row_html(const StageTimes& stage, std::size_t index, double total) {
  const std::optional<TimeSummary> times = summarize_times(stage.ms);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  std::string out = fmt::format("<tr><td><span class=\"key c{}\"></span>{}</td><td>{}</td>",
                                index % kColors,
                                html_escape(stage.name),
                                count_text(stage.ms.size()));
  for (const double ms : {times ? times->mean : nothing,
                          times ? times->median : nothing,
                          times ? times->p95 : nothing,
                          times ? times->max : nothing}) {
    out += fmt::format("<td>{}</td>", duration_text(ms));
  }
  return out + fmt::format("<td>{}</td></tr>",
                           total > 0 ? fmt::format("{:.1f} %", 100 * total_ms(stage) / total) : "");
}

std::string stages_html(const std::vector<StageTimes>& stages) {
  if (stages.empty()) return "<p>No stage was timed.</p>";
  const double total = total_ms(stages);
  std::string out =
      "<h3>Stages</h3>" + bar_html(stages, total) +
      "<div class=\"scroll\"><table><thead><tr><th>stage</th><th>times run</th><th>mean</th>"
      "<th>median</th><th>95 % within</th><th>max</th><th>share</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < stages.size(); ++i) out += row_html(stages[i], i, total);
  return out + "</tbody></table></div>";
}

std::string frames_html(const std::vector<double>& frame_ms) {
  const std::optional<TimeSummary> times = summarize_times(frame_ms);
  if (!times) return "<p>No frame was timed.</p>";
  Plot plot{.title = "Time per frame",
            .x_label = "frame",
            .y_label = "time (ms)",
            .series = {by_frame("frame", frame_ms, 0)},
            .height_px = 240,
            .y_from_zero = true};
  const double last = static_cast<double>(frame_ms.size() - 1);
  plot.series.push_back({.name = "median",
                         .points = {{0, times->median}, {last, times->median}},
                         .color = 3,
                         .style = PlotStyle::kDashed});
  return "<h3>Each frame, from its arrival to its pose, without the network</h3>" + plot_svg(plot);
}

std::string live_html(const std::optional<LiveReport>& live) {
  if (!live) return "";
  std::string out = fmt::format("<p>Live: {} frames were dropped, the network looked at {}",
                                count_text(live->dropped),
                                count_text(live->looked_at));
  if (const std::optional<TimeSummary> age = summarize_times(live->objects_age_frames)) {
    out += fmt::format(
        "; objects were {:.0f} frames old in the median, {:.0f} at 95 %", age->median, age->p95);
  }
  if (const std::optional<TimeSummary> latency = summarize_times(live->latency_ms)) {
    out += fmt::format(". A frame's pose was there {} after it came in the median, {} at 95 %",
                       duration_text(latency->median),
                       duration_text(latency->p95));
  }
  return out + ".</p>";
}

}  // namespace

std::string timing_html(const RunReport& report) {
  return live_html(report.live) + stages_html(report.stages) + frames_html(report.frame_ms);
}

std::string features_html(const RunReport& report) {
  if (report.tracked_features.empty()) return "<p>No counts of features were kept.</p>";
  const std::vector<double> counts(report.tracked_features.begin(), report.tracked_features.end());
  const Plot plot{.title = "Tracked features per frame",
                  .x_label = "frame",
                  .y_label = "features",
                  .series = {by_frame("", counts, 2)},
                  .height_px = 220,
                  .y_from_zero = true};
  return "<p class=\"note\">Features of each frame that were matched to the map and agree with its "
         "pose.</p>" +
         plot_svg(plot);
}

}  // namespace stillmap
