// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace stillmap {

/// The radius of the circle of 16 pixels around a corner.
inline constexpr int kCornerCircleRadiusPx = 3;

/// The score of each pixel as a FAST corner with an arc of nine (Rosten and Drummond, ECCV 2006):
/// the greatest t for which nine consecutive pixels of the circle around it are all brighter, or
/// all darker, than it by more than t. 0 where there is none, and nearer to the border than the
/// radius of the circle.
[[nodiscard]] cv::Mat1b corner_scores(const cv::Mat1b& image);

/// The pixels of `area`, which is inside the image, with a score of at least `threshold` (1 to 255)
/// greater than those of all eight neighbours in the area; row by row, with the score as response.
/// They are the corners that cv::FAST finds in the area.
[[nodiscard]] std::vector<cv::KeyPoint> local_maxima(const cv::Mat1b& scores,
                                                     const cv::Rect& area,
                                                     int threshold);

}  // namespace stillmap
