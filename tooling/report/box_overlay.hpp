// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The frame's objects as an SVG to lie over its picture: a box each, cut at the image's edge, with
/// the number of its track, its class, and why it is taken as dynamic (class "dyn") or static
/// ("sta"). Boxes that were filled in are dashed. Those outside the image and those that are no
/// boxes are left out; empty when nothing is left.
[[nodiscard]] std::string box_overlay_svg(const ReportSample& sample);

}  // namespace stillmap
