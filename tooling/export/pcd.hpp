// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

enum class PcdFormat { kBinary, kAscii };

/// PCD (version 0.7) of a cloud, as PCL's PointXYZRGBL has it: `x y z rgb label` and, when the
/// cloud has normals, `normal_x normal_y normal_z`. rgb is PCL's packed colour 0x00RRGGBB: in the
/// binary format as the bits of a float, in text as a whole number. `label` is 32 bits, 0 where the
/// cloud has none.
[[nodiscard]] std::string encode_pcd(const PointCloud& cloud, PcdFormat format);

}  // namespace stillmap
