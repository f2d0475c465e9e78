// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace stillmap {

/// The documentation and the range of a setting; its type and default are those of the member.
struct FieldInfo {
  std::string_view meaning;
  std::string_view unit = "";
  double min = std::numeric_limits<double>::lowest();  ///< numbers only
  double max = std::numeric_limits<double>::max();     ///< numbers only
  std::vector<std::string_view> choices = {};          ///< texts only; empty = any text
  bool common = false;  ///< one of the few settings that people change
};

/// The same setting, marked as one that people change.
[[nodiscard]] inline FieldInfo common_setting(FieldInfo info) {
  info.common = true;
  return info;
}

// A configuration struct names its fields once, in a static member template
//
//   template <class Self, class Visitor>
//   static void fields(Self& self, Visitor& visit) {
//     visit("voxel_size_m", self.voxel_size_m, FieldInfo{"edge of a voxel", "m", 0.001, 1.0});
//     visit("mode", self.mode, common_setting({"how to map", "", 0, 0, {"fast", "exact"}}));
//     visit.group("tracking", self.tracking);   // a nested struct
//   }
//
// That one list serves loading, saving, overriding on the command line and documentation. Values
// are bool, int, std::uint32_t, double or std::string.

}  // namespace stillmap
