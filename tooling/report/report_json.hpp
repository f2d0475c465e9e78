// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The figures of a run as JSON text, indented, with a line end; equal input gives equal text.
///
/// Every key is always present; a figure that is unknown or not finite is null, so that
/// `report["ate"]["rmse"]` is null, never an error, without ground truth. Only `time.stages_ms` has
/// one member per stage (stages of the same name share one), and `objects.classes` one per class.
/// `objects` counts tracks, and sightings (an object in a frame), those filled in and those taken
/// as dynamic among them. Times are milliseconds unless the key says `_s`; p95 is the nearest-rank
/// percentile. Invalid UTF-8 becomes replacement characters.
[[nodiscard]] std::string report_json(const RunReport& report);

}  // namespace stillmap
