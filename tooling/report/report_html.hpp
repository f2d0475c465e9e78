// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The report as one self-contained HTML page: figures, plots, pictures and a view of the map that
/// can be turned (WebGL 2, with pictures where that is missing). It opens from disk and fetches
/// nothing; its content security policy forbids it. Every text is escaped. Equal input gives equal
/// bytes. Sections without data say so.
[[nodiscard]] std::string report_html(const RunReport& report);

}  // namespace stillmap
