// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// What the report shows of a frame: its objects and masks, and its features with what became of
/// them.
[[nodiscard]] SampleFrame make_sample(const RgbdFrame& frame, const FrameResult& result);

}  // namespace stillmap
