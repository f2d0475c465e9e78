// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>

#include <fmt/core.h>

#include "tooling/report/display_text.hpp"
#include "tooling/report/page_sections.hpp"

namespace stillmap {
namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : kDash;
}

std::string percent(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.2f}\u00A0%", 100 * *ratio) : kDash;
}

std::string length(const std::optional<double>& metres) {
  return metres ? length_text(*metres) : kDash;
}

std::string row_html(const char* poses, const std::optional<MapQuality>& quality) {
  if (!quality) return "";
  const std::optional<GhostFigures>& ghosts = quality->ghosts;
  std::string out = fmt::format("<tr><th>{}</th>", poses);
  for (const std::string& cell : {number(quality->sa),
                                  number(quality->da),
                                  number(quality->aa),
                                  length(quality->accuracy_m),
                                  length(quality->completeness_m),
                                  ghosts ? percent(ghosts->ratio) : kDash,
                                  ghosts ? fmt::format("{:.1f}\u00A0l", ghosts->volume_l) : kDash,
                                  ghosts ? count_text(ghosts->clusters) : kDash}) {
    out += "<td>" + cell + "</td>";
  }
  return out + "</tr>";
}

}  // namespace

std::string map_quality_html(const RunReport& report) {
  if (!report.map_quality) return "";
  return "<h3>Against the true surfaces</h3><div class=\"scroll\"><table><thead><tr>"
         "<th>map with</th><th>static sa</th><th>dynamic da</th><th>both aa</th><th>accuracy</th>"
         "<th>completeness</th><th>ghosts</th><th>their volume</th><th>clusters</th></tr></thead>"
         "<tbody>" +
         (report.map_at_true_poses ? "" : row_html("estimated poses", report.map_quality)) +
         row_html("true poses", report.map_quality_true_poses) +
         "</tbody></table></div><p class=\"note\">sa: share of the true static surface within 5 cm "
         "of the map. da: share of what moving things swept that the map leaves free. aa: their "
         "geometric mean. Ghosts: map points where only moving things were.</p>";
}

}  // namespace stillmap
