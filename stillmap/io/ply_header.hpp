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

/// What the header of a PLY says about its element `vertex`, and where that begins.
struct PlyHeader {
  bool binary = false;  ///< little endian; else ASCII
  std::size_t vertices = 0;
  std::vector<PlyProperty> properties;  ///< of a vertex, in the file's order
  std::size_t vertex_offset = 0;        ///< bytes (binary) or ...
  std::size_t vertex_line = 0;          ///< ... lines of data (ASCII) before the vertices' first
  std::size_t header_bytes = 0;         ///< where the data begins
  std::size_t header_lines = 0;
};

/// Reads the header at the start of `bytes`. `name` stands in the messages. Throws Error for what
/// is no PLY, is big-endian, has no vertices' element, or has a list among or before the vertices.
[[nodiscard]] PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace stillmap
