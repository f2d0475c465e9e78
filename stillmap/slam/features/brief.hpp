// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/slam/features/descriptor.hpp"

namespace stillmap {

/// The radius of the round patch of a feature, pixels.
inline constexpr int kPatchRadiusPx = 15;

/// The direction from the centre of the patch to its centroid of brightness (Rosin 1999; Rublee et
/// al. 2011, Eq. (3)), degrees in [0, 360). The patch around `at` must be inside the image.
[[nodiscard]] float patch_orientation_deg(const cv::Mat1b& image, cv::Point at);

/// The descriptor: 256 comparisons of two points of the blurred patch, rotated by the orientation
/// of the patch. The rotated patch, rounded to pixels, must be inside the image.
[[nodiscard]] Descriptor rotated_brief(const cv::Mat1b& blurred, cv::Point at, float angle_deg);

}  // namespace stillmap
