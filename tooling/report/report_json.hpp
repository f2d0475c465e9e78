// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The figures of a run as JSON text, indented, with a line end; equal input gives equal text.
///
/// Every key is always there; a figure that is not known, or not finite, is null. So that
/// `report["ate"]["rmse"]` is null, never an error, when there was no ground truth. Only
/// `time.stages_ms` has as many members as there were stages (times of equally named stages are
/// taken together), and `objects.classes` as there were classes. `objects` counts tracks, and
/// sightings (an object in a frame), those filled in and those taken as dynamic among them. Times
/// are milliseconds unless the key says `_s`; p95 is the nearest-rank percentile. Text that is not
/// UTF-8 comes with replacement characters.
[[nodiscard]] std::string report_json(const RunReport& report);

}  // namespace stillmap
