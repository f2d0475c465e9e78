// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace stillmap {

/// Radius of the circle of 16 pixels that tells whether a pixel is a corner.
inline constexpr int kCornerCircleRadiusPx = 3;

/// How clearly each pixel is a FAST corner with an arc of nine (Rosten and Drummond, ECCV 2006):
/// the greatest t for which nine pixels in a row on the circle round it are all brighter, or all
/// darker, than it by more than t. 0 where there is none, and nearer to the border than the
/// circle's radius.
[[nodiscard]] cv::Mat1b corner_scores(const cv::Mat1b& image);

/// The pixels of `area`, inside the image, with a score of at least `threshold`, from 1 to 255,
/// that is greater than those of all eight neighbours in the area: row by row, with the score as
/// response. With the scores of an image they are what cv::FAST finds in the area.
[[nodiscard]] std::vector<cv::KeyPoint> local_maxima(const cv::Mat1b& scores,
                                                     const cv::Rect& area,
                                                     int threshold);

}  // namespace stillmap
