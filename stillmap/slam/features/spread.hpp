// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

namespace stillmap {

/// Selects about `count` corners, spread evenly over the image: the image is split as a quadtree,
/// the node with most corners first, until there are `count` nodes; each node keeps its strongest
/// corner (by response). Ties go to the earlier corner, so that the result depends on the input
/// alone. Returns at most `count` + 3 corners.
[[nodiscard]] std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> corners, int count);

}  // namespace stillmap
