// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// A copy of a depth image (metres) without small patches (Fan 2020, section III-D, Eq. (13)).
///
/// A patch is a 4-connected component of pixels with depth over 0. Diagonal neighbours are not
/// connected, since that would lead around the ends of the lines that without_edges() draws between
/// objects. A patch of fewer than `min_pixels` pixels becomes 0.
[[nodiscard]] cv::Mat1f without_islands(const cv::Mat1f& depth, double min_pixels);

}  // namespace stillmap
