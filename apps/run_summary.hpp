// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// What a run prints at its end. `objects_line` says what found people and things, `out` is the
/// folder of the results.
[[nodiscard]] std::string run_summary(const RunReport& report,
                                      const std::string& objects_line,
                                      const std::filesystem::path& out);

}  // namespace stillmap
