// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/report_html.hpp"

#include <map>

#include "tooling/report/page_assets.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/page_text.hpp"

namespace stillmap {

std::string report_html(const RunReport& report) {
  const RunStatus status = run_status(report);
  const MapHtml map = map_html(report);
  const std::map<std::string, std::string> values = {
      {"sequence", html_escape(report.sequence.empty() ? "Unnamed sequence" : report.sequence)},
      {"version", html_escape(report.version)},
      {"css", std::string(page_css())},
      {"status", html_escape(status.text)},
      {"status_class", status.good ? "good" : "bad"},
      {"facts", facts_html(report)},
      {"tiles", tiles_html(report)},
      {"warnings", warnings_html(report)},
      {"map", map.section},
      {"trajectory", trajectory_html(report)},
      {"error", error_html(report)},
      {"timing", timing_html(report)},
      {"features", features_html(report)},
      {"objects", objects_html(report)},
      {"samples", samples_html(report)},
      {"details", details_html(report)},
      {"script", map.script}};
  return fill_template(page_html(), values);
}

}  // namespace stillmap
