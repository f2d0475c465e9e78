// SPDX-License-Identifier: Apache-2.0
// What all fuzzers of readers share. A fuzzer is a file with STILLMAP_FUZZER.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap::fuzz {

/// Ends the process, with a crash, where something that must hold does not.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Calls `read`, which may throw an Error of one line, and nothing else.
template <class Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string_view text = error.what();
    require(!text.empty() && text.find('\n') == std::string_view::npos, "one line of error");
  }
}

/// The parts of an input that are separated by lines "----"; `count` of them, the last with all the
/// rest, missing ones empty.
inline std::vector<std::string_view> parts_of(std::string_view bytes, std::size_t count) {
  constexpr std::string_view kLine = "----\n";
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < count) {
    const std::size_t end = std::min(bytes.find(kLine), bytes.size());
    parts.push_back(bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + kLine.size(), bytes.size()));
  }
  parts.push_back(bytes);
  return parts;
}

/// A folder in memory, for readers of files; removed at the end of the process.
class MemoryFolder {
 public:
  MemoryFolder() {
    std::string name = "/dev/shm/stillmap_fuzz_XXXXXX";
    require(::mkdtemp(name.data()) != nullptr, "a folder in /dev/shm");
    path_ = name;
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;
  ~MemoryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Writes a file; its path.
  [[nodiscard]] std::filesystem::path put(const char* name, std::string_view bytes) const {
    const std::filesystem::path path = path_ / name;
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    require(file != nullptr, "a file in /dev/shm");
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
    return path;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace stillmap::fuzz

/// Defines the entry point of libFuzzer, which gives each input to `try_bytes`.
#define STILLMAP_FUZZER(try_bytes)                                                    \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    try_bytes(std::string_view(reinterpret_cast<const char*>(data), size));           \
    return 0;                                                                         \
  }
