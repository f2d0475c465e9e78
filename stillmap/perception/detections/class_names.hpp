// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// The 80 classes of COCO, in the order in which networks number them: "person" is the first.
[[nodiscard]] std::span<const std::string_view> coco_class_names();

[[nodiscard]] bool is_coco_class(std::string_view name);

inline constexpr std::size_t kMaxClassNameBytes = 256;

/// Whether a text can be the name of a class, in any language: 1 to kMaxClassNameBytes bytes of
/// UTF-8 without control characters.
[[nodiscard]] bool is_class_name(std::string_view text);

/// The name of a class that a network's file gives, as one that is_class_name() takes: bytes that
/// are none of UTF-8 or control characters become '?', a longer name is cut. "?" for no name.
[[nodiscard]] std::string usable_class_name(std::string_view text);

/// The COCO name of a class under any of its names: "tvmonitor" of VOC -> "tv", "Pedestrian" and
/// "man" -> "person". Case, blanks and signs between words make no difference: "Dining_Table" ->
/// "dining table". Any other name is returned unchanged.
[[nodiscard]] std::string coco_name(std::string_view name);

/// Whether two names of classes differ at most in case, blanks and signs.
[[nodiscard]] bool is_same_name(std::string_view a, std::string_view b);

}  // namespace stillmap
