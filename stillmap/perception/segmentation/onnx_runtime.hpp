// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "stillmap/perception/segmentation/network.hpp"

namespace stillmap {

struct OnnxOptions {
  int threads = 2;  ///< that work on one run
};

/// Whether this build can run ONNX networks: its headers were there when it was configured. The
/// library itself is looked for when the first network is opened.
[[nodiscard]] bool built_with_onnx_runtime();

/// Opens a network with one input of floats. The first call in a program loads ONNX Runtime, from
/// the first of onnx_runtime_libraries() that is there. Throws Error, with what to do, when this
/// build cannot run ONNX networks, when there is no library or one that is too old, and when the
/// file is missing or no such network.
[[nodiscard]] std::unique_ptr<Network> open_onnx_network(const std::filesystem::path& file,
                                                         const OnnxOptions& options);

}  // namespace stillmap
