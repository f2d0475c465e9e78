// SPDX-License-Identifier: Apache-2.0
#include "apps/run_summary.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "tooling/report/time_summary.hpp"
#include "tooling/report/tracking_gaps.hpp"

namespace stillmap {
namespace {

std::string map_line(const RunReport& report) {
  std::string text = fmt::format("map         {} points", report.map->size());
  if (report.map_quality) text += fmt::format(", sa {:.3f}", report.map_quality->sa);
  if (report.map_quality && report.map_quality->da) {
    text += fmt::format(", da {:.3f}", *report.map_quality->da);
  }
  return text + (report.map_at_true_poses ? ", at true poses\n" : "\n");
}

std::string judge_line(const RunReport& report) {
  std::string text;
  for (const auto& [judge, frames] : report.matches_judged_by) {
    text += fmt::format("{}{} in {} frames", text.empty() ? "" : ", ", judge, frames);
  }
  return text.empty() ? text : fmt::format("matches     judged by {}\n", text);
}

std::string live_line(const RunReport& report) {
  if (!report.live) return {};
  const LiveReport& live = *report.live;
  std::string text = fmt::format("live        {} of {} frames dropped, {} looked at",
                                 live.dropped,
                                 report.frames_total,
                                 live.looked_at);
  if (const std::optional<TimeSummary> latency = summarize_times(live.latency_ms)) {
    text += fmt::format(
        "; pose after {:.0f} ms (median), {:.0f} ms (95 %)", latency->median, latency->p95);
  }
  return text + "\n";
}

std::string gap_lines(const RunReport& report) {
  constexpr std::size_t kMost = 5;
  const std::vector<TrackingGap> gaps = tracking_gaps(report.lost, report.estimate);
  std::string text;
  for (std::size_t i = 0; i < std::min(gaps.size(), kMost); ++i) {
    text += fmt::format("no pose     {}\n", gap_text(gaps[i]));
  }
  if (gaps.size() > kMost) text += fmt::format("            and {} more\n", gaps.size() - kMost);
  return text;
}

}  // namespace

std::string run_summary(const RunReport& report,
                        const std::string& input_line,
                        const std::string& objects_line,
                        const std::filesystem::path& out) {
  std::string text =
      fmt::format("input       {}\nobjects     {}\ntracked     {} of {} frames, {} key frames\n",
                  input_line,
                  objects_line,
                  report.frames_tracked,
                  report.frames_total,
                  report.keyframes.size());
  text += gap_lines(report);
  if (report.ate) {
    text += fmt::format("ATE         {:.4f} m rmse over {} poses\n",
                        report.ate->translation_m.rmse,
                        report.ate->pairs.size());
  }
  if (!report.loops.empty()) {
    text += fmt::format("loops       {} closed\n", report.loops.size());
  }
  text += judge_line(report);
  text += live_line(report);
  text += map_line(report);
  text += fmt::format("time        {:.1f} s, {:.1f} frames a second\n",
                      *report.wall_s,
                      static_cast<double>(report.frames_total) / *report.wall_s);
  text += fmt::format("report      {}\n", (out / "report.html").string());
  return text;
}

}  // namespace stillmap
