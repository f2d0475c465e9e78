// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace stillmap {

/// The folder into which tools/fetch_models puts networks and ONNX Runtime: $STILLMAP_MODELS, else
/// $XDG_DATA_HOME/stillmap/models, else ~/.local/share/stillmap/models, where these are absolute;
/// else /usr/local/share/stillmap/models.
[[nodiscard]] std::filesystem::path model_folder();

/// The paths at which the library of ONNX Runtime is looked for, in order: $STILLMAP_ONNXRUNTIME
/// alone if it is set, else the folder of the models, then the library that the system's loader
/// finds.
[[nodiscard]] std::vector<std::filesystem::path> onnx_runtime_libraries();

}  // namespace stillmap
