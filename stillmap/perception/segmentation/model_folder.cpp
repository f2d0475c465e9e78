// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/model_folder.hpp"

#include <cstdlib>
#include <string>

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// The value of an environment variable; empty if it is not set.
std::string environment(const char* name) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): this program never changes the environment
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

fs::path model_folder() {
  const std::string given = environment("STILLMAP_MODELS");
  if (!given.empty()) return given;
  const std::string data = environment("XDG_DATA_HOME");
  const fs::path base =
      data.empty() ? fs::path(environment("HOME")) / ".local/share" : fs::path(data);
  return base / "stillmap/models";
}

std::vector<fs::path> onnx_runtime_libraries() {
  const std::string given = environment("STILLMAP_ONNXRUNTIME");
  if (!given.empty()) return {given};
  return {model_folder() / "libonnxruntime.so.1", "libonnxruntime.so.1", "libonnxruntime.so"};
}

}  // namespace stillmap
