// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// The slope of the steepest ray that has a feature: the tangent of 70 degrees from the axis.
/// Errors of features are in pixels of an image without distortion, where a pixel of a fish-eye is
/// nine pixels wide at this angle, and wider farther out.
inline constexpr double kSteepestFeature = 2.75;

}  // namespace stillmap
