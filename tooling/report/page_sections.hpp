// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

// The parts of the report's page, as HTML; a part without data says so.

struct RunStatus {
  bool good = false;
  std::string text;  ///< plain, not escaped
};

/// A sentence that says whether every frame was tracked.
[[nodiscard]] RunStatus run_status(const RunReport& report);

[[nodiscard]] std::string facts_html(const RunReport& report);  ///< camera, length, time taken
[[nodiscard]] std::string tiles_html(const RunReport& report);
[[nodiscard]] std::string warnings_html(const RunReport& report);  ///< empty for no warnings
[[nodiscard]] std::string details_html(const RunReport& report);

[[nodiscard]] std::string trajectory_html(const RunReport& report);
[[nodiscard]] std::string error_html(const RunReport& report);

[[nodiscard]] std::string timing_html(const RunReport& report);
[[nodiscard]] std::string features_html(const RunReport& report);

[[nodiscard]] std::string objects_html(const RunReport& report);
[[nodiscard]] std::string samples_html(const RunReport& report);

struct MapHtml {
  std::string section;
  std::string script;  ///< for the end of the page; empty without a map
};
[[nodiscard]] std::string map_quality_html(const RunReport& report);  ///< empty without truth
[[nodiscard]] MapHtml map_html(const RunReport& report);

/// Second 0 of plots and captions: the earliest stamp of the run's frames.
[[nodiscard]] double first_stamp_s(const RunReport& report);

}  // namespace stillmap
