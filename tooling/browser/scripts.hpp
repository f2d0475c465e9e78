// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace stillmap {

// The texts of the files of these names, embedded when building; empty where libjs-three was not
// there then.
[[nodiscard]] std::string_view three_min_js();
[[nodiscard]] std::string_view OrbitControls_js();  // NOLINT(readability-identifier-naming)

[[nodiscard]] std::string_view cameras_js();
[[nodiscard]] std::string_view keys_js();
[[nodiscard]] std::string_view labels_js();
[[nodiscard]] std::string_view message_js();
[[nodiscard]] std::string_view objects_js();
[[nodiscard]] std::string_view points_js();
[[nodiscard]] std::string_view records_js();
[[nodiscard]] std::string_view run_scene_js();
[[nodiscard]] std::string_view scene_js();
[[nodiscard]] std::string_view scrubber_js();
[[nodiscard]] std::string_view shading_js();

}  // namespace stillmap
