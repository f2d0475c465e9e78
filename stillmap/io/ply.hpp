// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

enum class PlyFormat { kBinary, kAscii };

/// A cloud as PLY, binary little-endian or text: for each point `float x y z`, `uchar red green
/// blue`, `uchar label` (0 if the cloud has no labels) and, if it has normals, `float nx ny nz`.
/// Text has the fewest digits that read back to the same bits.
[[nodiscard]] std::string encode_ply(const PointCloud& cloud,
                                     PlyFormat format = PlyFormat::kBinary);

/// Reads the points of a PLY, binary little-endian or ASCII, with the properties in any order and
/// of any scalar type. Other properties and elements are skipped. Points without colours become
/// gray (128). Throws Error for a big-endian or truncated file, a count too large for the file,
/// missing x, y or z, only some of nx ny nz or red green blue, positions that are not finite,
/// colours or labels outside 0 to 255, and a list property among or before the points.
[[nodiscard]] PointCloud read_ply(const std::filesystem::path& path);

}  // namespace stillmap
