// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// The image smoothed by a Gaussian with a standard deviation of 2 pixels, cut off at 3, for the
/// comparisons of descriptors. Gives the same bits as cv::GaussianBlur with a 7x7 kernel and
/// mirrored borders in a fraction of the time. The image must have at least 4 rows and columns.
[[nodiscard]] cv::Mat1b blurred_for_descriptors(const cv::Mat1b& image);

}  // namespace stillmap
