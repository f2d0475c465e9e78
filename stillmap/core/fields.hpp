// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string_view>
#include <vector>

namespace stillmap {

/// What is known of a configuration value besides its type and default.
struct FieldInfo {
  std::string_view meaning;
  std::string_view unit = "";
  double min = std::numeric_limits<double>::lowest();  ///< for numbers
  double max = std::numeric_limits<double>::max();
  std::vector<std::string_view> choices = {};  ///< for texts; empty = any
};

// A configuration struct names its fields once, in a static member template
//
//   template <class Self, class Visitor>
//   static void fields(Self& self, Visitor& visit) {
//     visit("voxel_size_m", self.voxel_size_m, FieldInfo{"edge of a voxel", "m", 0.001, 1.0});
//     visit.group("tracking", self.tracking);   // a nested struct
//   }
//
// Loading, saving, command-line overrides and documentation all come from that one list. Values
// are bool, int, std::uint32_t, double or std::string.

}  // namespace stillmap
