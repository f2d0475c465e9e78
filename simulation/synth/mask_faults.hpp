// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace stillmap {

// What networks do to masks. A mask is 255 where an object is, else 0, with some room around it;
// every function returns a new one and depends on its arguments alone.

/// Moves the edge inwards by `loss_px` on average, and by up to `wander_px` more or less in slow
/// waves along it: thin parts vanish, in places the background is taken in.
[[nodiscard]] cv::Mat1b with_wandering_edge(const cv::Mat1b& mask,
                                            double loss_px,
                                            double wander_px,
                                            std::uint64_t key);

/// Takes away a block at one end: a lower corner (a leg), a part of a side (an arm), seldom the top
/// (a head). Between a tenth and a third of the mask's height or width.
[[nodiscard]] cv::Mat1b with_end_cut_off(const cv::Mat1b& mask, std::uint64_t key);

/// Adds an ellipse about a place on the edge, as large as 4 to 9 % of the mask's box.
[[nodiscard]] cv::Mat1b with_leak(const cv::Mat1b& mask, std::uint64_t key);

}  // namespace stillmap
