// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/slam/features/descriptor.hpp"

namespace stillmap {

/// Radius of the round patch that a feature is described by.
inline constexpr int kPatchRadiusPx = 15;

/// Direction from the patch's centre to its centroid of brightness (Rosin 1999; ORB, Eq. 3),
/// degrees in [0, 360). The patch round `at` lies inside the image.
[[nodiscard]] float patch_orientation_deg(const cv::Mat1b& image, cv::Point at);

/// 256 comparisons of two points of the blurred patch, at places turned by the patch's orientation.
/// The turned patch, rounded to pixels, lies inside the image.
[[nodiscard]] Descriptor rotated_brief(const cv::Mat1b& blurred, cv::Point at, float angle_deg);

}  // namespace stillmap
