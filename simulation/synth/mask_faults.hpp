// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace stillmap {

// Faults of networks in masks. A mask is 255 on the object and 0 elsewhere, with a margin around
// the object. Each function returns a new mask that depends on the arguments alone.

/// Moves the edge inwards by `loss_px` on average, and by up to `wander_px` more or less in slow
/// waves along it. Thin parts vanish; in places background is included.
[[nodiscard]] cv::Mat1b with_wandering_edge(const cv::Mat1b& mask,
                                            double loss_px,
                                            double wander_px,
                                            std::uint64_t key);

/// Removes a block at one end, of a tenth to a third of the mask's height or width: a lower corner
/// (a leg), a part of a side (an arm), seldom the top (a head).
[[nodiscard]] cv::Mat1b with_end_cut_off(const cv::Mat1b& mask, std::uint64_t key);

/// Adds an ellipse around a point of the edge, with 4 to 9 % of the area of the mask's box.
[[nodiscard]] cv::Mat1b with_leak(const cv::Mat1b& mask, std::uint64_t key);

}  // namespace stillmap
