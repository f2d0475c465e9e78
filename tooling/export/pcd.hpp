// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

enum class PcdFormat { kBinary, kAscii };

/// A cloud as PCD (version 0.7) with the fields of PCL's PointXYZRGBL: `x y z rgb label` and, if
/// the cloud has normals, `normal_x normal_y normal_z`. rgb is the packed colour 0x00RRGGBB: the
/// bits of a float in the binary format, a whole number in text. `label` has 32 bits, 0 if the
/// cloud has no labels.
[[nodiscard]] std::string encode_pcd(const PointCloud& cloud, PcdFormat format);

}  // namespace stillmap
