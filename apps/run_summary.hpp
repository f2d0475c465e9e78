// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The lines that `stillmap run` prints at its end. `input_line` says how the recording was read,
/// `objects_line` what finds people and
/// things, `out` is the folder of the results. The report has a map and the time of the run.
[[nodiscard]] std::string run_summary(const RunReport& report,
                                      const std::string& input_line,
                                      const std::string& objects_line,
                                      const std::filesystem::path& out);

}  // namespace stillmap
