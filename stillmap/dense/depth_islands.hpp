// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// A copy of a depth image (metres) without small patches (Fan 2020, Eq. (13)).
///
/// A patch is what hangs together of pixels with depth (over 0), each having a neighbour in its row
/// or its column; corners do not hang together, for that would lead round the ends of the lines
/// that without_edges() draws between objects. A patch of fewer than `min_pixels` pixels becomes 0.
[[nodiscard]] cv::Mat1f without_islands(const cv::Mat1f& depth, double min_pixels);

}  // namespace stillmap
