// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// What `stillmap run` prints at its end: one line for each result. `out` is the run's folder,
/// `objects_line` says what found people and things.
[[nodiscard]] std::string run_summary(const RunReport& report,
                                      const std::filesystem::path& out,
                                      const std::string& objects_line);

}  // namespace stillmap
