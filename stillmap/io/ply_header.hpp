// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

[[nodiscard]] std::size_t byte_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
};

/// The element `vertex` as the header of a PLY describes it, and the place of its data.
struct PlyHeader {
  bool binary = false;  ///< little endian; else ASCII
  std::size_t vertices = 0;
  std::vector<PlyProperty> properties;  ///< of a vertex, in the order of the file
  std::size_t vertex_offset = 0;        ///< bytes of data before the first vertex (binary)
  std::size_t vertex_line = 0;          ///< lines of data before the first vertex (ASCII)
  std::size_t header_bytes = 0;         ///< size of the header; the data follows
  std::size_t header_lines = 0;
};

/// Reads the header at the start of `bytes`. Messages call the file `name`. Throws Error for a file
/// that is no PLY, is big-endian, has no element `vertex`, or has a list property among or before
/// the vertices.
[[nodiscard]] PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace stillmap
