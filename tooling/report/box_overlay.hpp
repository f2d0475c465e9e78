// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The frame's objects as an SVG overlay of its picture: for each a box, cut at the image's edge,
/// with its track number, its class, and why it counts as dynamic (CSS class "dyn") or static
/// ("sta"). Filled-in boxes are dashed. Boxes outside the image and invalid boxes are left out; the
/// text is empty when none is left.
[[nodiscard]] std::string box_overlay_svg(const ReportSample& sample);

}  // namespace stillmap
