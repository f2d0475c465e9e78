// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include "tooling/report/display_text.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/page_text.hpp"

namespace stillmap {
namespace {

/// "still 80 %, moved by someone 20 %", the most frequent first; a dash where nothing is known.
std::string motion_text(const ObjectSummary& object) {
  std::vector<ObjectSummary::MotionCount> known;
  for (const ObjectSummary::MotionCount& count : object.motions) {
    if (count.motion != "unknown") known.push_back(count);
  }
  std::ranges::stable_sort(known, std::ranges::greater{}, &ObjectSummary::MotionCount::frames);
  std::string text;
  for (const ObjectSummary::MotionCount& count : known) {
    text += fmt::format(
        "{}{} {}", text.empty() ? "" : ", ", count.motion, share_text(count.frames, object.frames));
  }
  return text.empty() ? "\u2013" : text;
}

std::string row_html(const ObjectSummary& object) {
  return fmt::format(
      "<tr><td>#{} {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
      object.track,
      html_escape(object.class_name),
      html_escape(object.category),
      count_text(object.frames),
      count_text(object.filled),
      share_text(object.dynamic, object.frames),
      html_escape(object.main_reason),
      html_escape(motion_text(object)));
}

std::string vacated_html(const std::vector<VacatedPlace>& places) {
  std::string text;
  for (const VacatedPlace& place : places) {
    text += fmt::format(
        "<p class=\"note\">#{} left its place while nobody looked, and is #{} now, with a "
        "confidence of {:.2f}: {}.</p>",
        place.left.value,
        place.found.value,
        place.confidence,
        place.counts() ? "its old place is not in the map"
                       : "too little, both places are in the map");
  }
  return text;
}

}  // namespace

std::string objects_html(const RunReport& report) {
  if (!report.objects) {
    return report.dynamics_mode == "off" || report.dynamics_mode.empty()
               ? "<p>Everything was taken as static: nothing was asked to look for what moves.</p>"
               : "<p>No network looked for objects.</p>";
  }
  if (report.objects->empty()) return "<p>No objects were found.</p>";
  constexpr std::size_t kMost = 20;
  std::vector<ObjectSummary> objects = *report.objects;
  std::ranges::stable_sort(objects, std::ranges::greater{}, &ObjectSummary::frames);
  std::string rows;
  for (std::size_t i = 0; i < std::min(kMost, objects.size()); ++i) rows += row_html(objects[i]);
  std::string rest;
  if (objects.size() > kMost) {
    rest = fmt::format("<p class=\"note\">and {} more, in no more than {} frames each</p>",
                       count_text(objects.size() - kMost),
                       count_text(objects[kMost].frames));
  }
  return fmt::format(
      "<p class=\"note\">What the network has found, followed over frames, most frames first. "
      "Dynamics: "
      "{}. Shares are of the object's own frames.</p><div class=\"scroll\"><table class=\"words\">"
      "<tr><th>object</th><th>category</th><th>frames</th><th>filled in</th><th>dynamic</th>"
      "<th>mostly because</th><th>motion</th></tr>{}</table></div>{}{}",
      html_escape(report.dynamics_mode),
      rows,
      rest,
      vacated_html(report.vacated));
}

}  // namespace stillmap
