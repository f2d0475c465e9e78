// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/report/run_report.hpp"

namespace stillmap {

/// A copy of the frame's image, made smaller where it is wider than `max_width_px`, with its
/// features drawn: tracked ones as green rings, the others as small grey ones below them. Features
/// outside the image are left out; an empty image stays empty.
[[nodiscard]] ColorImage draw_features(const SampleFrame& frame, int max_width_px);

}  // namespace stillmap
