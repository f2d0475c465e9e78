// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

enum class PlyFormat { kBinary, kAscii };

/// PLY of a cloud, binary little-endian or text: per point `float x y z`, `uchar red green blue`,
/// `uchar label` (0 where the cloud has no labels) and, when it has normals, `float nx ny nz`. Text
/// has as many digits as it takes to read back the same bits.
[[nodiscard]] std::string encode_ply(const PointCloud& cloud,
                                     PlyFormat format = PlyFormat::kBinary);

/// Reads the points of a PLY, binary little-endian or ASCII, with the properties in any order and
/// of any scalar type; properties and elements of other names are skipped. Points without colours
/// become gray (128). Throws Error for a big-endian or truncated file, a count that the file is too
/// short for, missing x, y or z, only some of nx ny nz or red green blue, positions that are not
/// finite, colours or labels outside 0-255, a list among or before the points.
[[nodiscard]] PointCloud read_ply(const std::filesystem::path& path);

}  // namespace stillmap
