// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace stillmap {

/// Where tools/fetch_models puts networks and ONNX Runtime: $STILLMAP_MODELS, else
/// $XDG_DATA_HOME/stillmap/models, else ~/.local/share/stillmap/models.
[[nodiscard]] std::filesystem::path model_folder();

/// Where ONNX Runtime's library is looked for, in this order: $STILLMAP_ONNXRUNTIME alone where
/// that is set, else the folder of the models, then what the system's loader finds.
[[nodiscard]] std::vector<std::filesystem::path> onnx_runtime_libraries();

}  // namespace stillmap
