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
  // Never a folder of the working directory: a library is loaded from this one.
  const fs::path data = environment("XDG_DATA_HOME"), home = environment("HOME");
  if (data.is_absolute()) return data / "stillmap/models";
  if (home.is_absolute()) return home / ".local/share/stillmap/models";
  return "/usr/local/share/stillmap/models";
}

std::vector<fs::path> onnx_runtime_libraries() {
  const std::string given = environment("STILLMAP_ONNXRUNTIME");
  if (!given.empty()) return {given};
  return {model_folder() / "libonnxruntime.so.1", "libonnxruntime.so.1", "libonnxruntime.so"};
}

}  // namespace stillmap
