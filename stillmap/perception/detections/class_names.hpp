// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// The 80 classes of COCO, in the order in which networks number them: "person" is the first.
[[nodiscard]] std::span<const std::string_view> coco_class_names();

[[nodiscard]] bool is_coco_class(std::string_view name);

/// The COCO name of a class that VOC names differently ("tvmonitor" -> "tv"); any other name
/// unchanged.
[[nodiscard]] std::string coco_name(std::string_view name);

}  // namespace stillmap
