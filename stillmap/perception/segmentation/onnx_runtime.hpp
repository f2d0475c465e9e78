// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "stillmap/perception/segmentation/network.hpp"

namespace stillmap {

struct OnnxOptions {
  int threads = 2;  ///< number of threads for one run
};

/// Whether this build can run ONNX networks: whether the headers of ONNX Runtime were found by
/// CMake. The library is looked for when the first network is opened.
[[nodiscard]] bool built_with_onnx_runtime();

/// Opens a network with one input of floats. The first call in a program loads ONNX Runtime from
/// the first of onnx_runtime_libraries() that exists. Throws Error, with advice, when this build
/// cannot run ONNX networks, when the library is missing or too old, and when the file is missing
/// or no such network.
[[nodiscard]] std::unique_ptr<Network> open_onnx_network(const std::filesystem::path& file,
                                                         const OnnxOptions& options);

}  // namespace stillmap
