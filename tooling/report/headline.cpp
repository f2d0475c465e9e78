// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "stillmap/sensor/stamp_interval.hpp"
#include "tooling/report/display_text.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/page_text.hpp"
#include "tooling/report/time_summary.hpp"
#include "tooling/report/tracking_gaps.hpp"

namespace stillmap {
namespace {

struct Tile {
  std::string name, value, remark;
};

std::string plural(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count_text(count), noun, count == 1 ? "" : "s");
}

const char* why_no_error(const RunReport& report) {
  return report.groundtruth ? "too little ground truth" : "no ground truth";
}

Tile ate_tile(const RunReport& report) {
  if (!report.ate) return {"Trajectory error", kDash, why_no_error(report)};
  const Statistics& s = report.ate->translation_m;
  return {"Trajectory error",
          length_text(s.rmse),
          fmt::format("ATE rmse; median {}, max {}", length_text(s.median), length_text(s.max))};
}

Tile rpe_tile(const RunReport& report) {
  if (!report.rpe) return {"Drift", kDash, why_no_error(report)};
  return {
      "Drift",
      length_text(report.rpe->translation_m.rmse),
      fmt::format(
          "RPE rmse; {:.2f}\u00B0 in {:g} s", report.rpe->rotation_deg.rmse, report.rpe->delta_s)};
}

Tile tracked_tile(const RunReport& report) {
  return {"Frames tracked",
          share_text(report.frames_tracked, report.frames_total),
          fmt::format("{} of {}; {}, {} closed",
                      count_text(report.frames_tracked),
                      count_text(report.frames_total),
                      plural(report.keyframes.size(), "key frame"),
                      plural(report.loops.size(), "loop"))};
}

Tile time_tile(const RunReport& report) {
  const std::optional<TimeSummary> times = summarize_times(report.frame_ms);
  if (!times) return {"Time per frame", kDash, "no frames timed"};
  return {
      "Time per frame",
      duration_text(times->median),
      fmt::format(
          "median; 95 % within {}, max {}", duration_text(times->p95), duration_text(times->max))};
}

Tile map_tile(const RunReport& report) {
  if (report.map == nullptr) return {"Map points", kDash, "no map was made"};
  const std::optional<MapQuality>& quality = report.map_quality;
  if (quality && quality->ghosts && quality->ghosts->ratio) {
    return {"Map points",
            count_text(report.map->size()),
            fmt::format("{:.1f} % of the surface, {:.2f} % ghosts",
                        100 * quality->sa,
                        100 * *quality->ghosts->ratio)};
  }
  return {"Map points",
          count_text(report.map->size()),
          report.map->empty() ? "the map is empty" : "of the static world"};
}

Tile memory_tile(const RunReport& report) {
  return {"Peak memory",
          report.peak_memory_mb ? memory_text(*report.peak_memory_mb) : kDash,
          report.wall_s ? fmt::format("{} in all", duration_text(*report.wall_s * 1000)) : ""};
}

template <class Item, class ToText>
std::string list_html(const std::vector<Item>& items, const ToText& to_text) {
  constexpr std::size_t kMost = 200;  // a run on broken data must not make a very long page
  std::string out = "<ul>";
  for (std::size_t i = 0; i < std::min(items.size(), kMost); ++i) {
    out += "<li>" + html_escape(to_text(items[i])) + "</li>";
  }
  if (items.size() > kMost) out += fmt::format("<li>and {} more</li>", items.size() - kMost);
  return out + "</ul>";
}

}  // namespace

RunStatus run_status(const RunReport& report) {
  if (report.frames_total == 0) return {false, "No frames"};
  if (report.frames_tracked == 0) return {false, "No frame could be tracked"};
  if (report.frames_tracked >= report.frames_total) return {true, "All frames tracked"};
  std::string text = plural(report.frames_total - report.frames_tracked, "frame") + " not tracked";
  if (!report.skipped.empty())
    text += fmt::format(", {} of them unreadable", count_text(report.skipped.size()));
  return {false, text};
}

std::string facts_html(const RunReport& report) {
  const CameraModel& camera = report.camera;
  std::string text = fmt::format("Camera {}, {} \u00D7 {} pixels, f = {:.1f}, {:.1f}",
                                 camera.name.empty() ? "without a name" : camera.name,
                                 camera.width_px,
                                 camera.height_px,
                                 camera.fx,
                                 camera.fy);
  if (report.estimate.size() > 1) {
    double metres = 0;
    for (std::size_t i = 1; i < report.estimate.size(); ++i) {
      metres += (report.estimate[i].T_world_camera.translation() -
                 report.estimate[i - 1].T_world_camera.translation())
                    .norm();
    }
    const double seconds =
        report.estimate.back().stamp.seconds - report.estimate.front().stamp.seconds;
    text += fmt::format(" \u00B7 {} of path", length_text(metres));
    const auto intervals = static_cast<double>(report.estimate.size() - 1);
    if (!is_absurd_interval(seconds / intervals)) text += fmt::format(" in {:.1f} s", seconds);
  }
  return html_escape(text);
}

std::string tiles_html(const RunReport& report) {
  std::string out = "<div class=\"tiles\">";
  for (const Tile& tile : {ate_tile(report),
                           rpe_tile(report),
                           tracked_tile(report),
                           time_tile(report),
                           map_tile(report),
                           memory_tile(report)}) {
    out += fmt::format("<div class=\"tile\"><h3>{}</h3><b>{}</b><span>{}</span></div>",
                       tile.name,
                       tile.value,
                       tile.remark);
  }
  return out + "</div>";
}

std::string warnings_html(const RunReport& report) {
  if (report.warnings.empty()) return "";
  return fmt::format("<details class=\"alert\" open><summary>{}</summary>{}</details>",
                     plural(report.warnings.size(), "warning"),
                     list_html(report.warnings, [](const std::string& text) { return text; }));
}

std::string details_html(const RunReport& report) {
  std::string out;
  if (!report.skipped.empty()) {
    out += fmt::format("<details><summary>{} could not be read</summary>{}</details>",
                       plural(report.skipped.size(), "frame"),
                       list_html(report.skipped, [](const DamagedFrame& f) {
                         return f.stamp.text + ": " + f.damage;
                       }));
  }
  if (!report.lost.empty()) {
    const std::vector<TrackingGap> gaps = tracking_gaps(report.lost, report.estimate);
    out += fmt::format("<details open><summary>{} in tracking</summary>{}</details>",
                       plural(gaps.size(), "gap"),
                       list_html(gaps, gap_text));
    out += fmt::format("<details><summary>{} without a pose</summary>{}</details>",
                       plural(report.lost.size(), "frame"),
                       list_html(report.lost, [](const Stamp& stamp) { return stamp.text; }));
  }
  return out +
         fmt::format("<details><summary>Effective configuration</summary><pre>{}</pre></details>",
                     html_escape(report.config_yaml));
}

double first_stamp_s(const RunReport& report) {
  double first = std::numeric_limits<double>::infinity();
  const auto consider = [&first](const Stamp& stamp) { first = std::min(first, stamp.seconds); };
  if (!report.estimate.empty()) consider(report.estimate.front().stamp);
  if (!report.lost.empty()) consider(report.lost.front());
  if (!report.skipped.empty()) consider(report.skipped.front().stamp);
  if (!report.samples.empty()) consider(report.samples.front().first.stamp);
  return first == std::numeric_limits<double>::infinity() ? 0 : first;
}

}  // namespace stillmap
