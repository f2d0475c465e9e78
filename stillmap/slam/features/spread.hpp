// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

namespace stillmap {

/// Keeps at most about `count` corners, spread evenly over the image: the image is split as a
/// quadtree, always the node with most corners next, until there are `count` nodes; each node keeps
/// its strongest corner (by response). Ties go to the earlier corner, so that the choice depends on
/// the input alone. At most 3 more than `count` are returned.
[[nodiscard]] std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> corners, int count);

}  // namespace stillmap
