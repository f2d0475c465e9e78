// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "stillmap/io/file_descriptor.hpp"

namespace stillmap {

/// A file of TMPDIR (else /tmp) without a name: nothing of it stays, however the process ends. What
/// has been written stays as it is; any number of threads may add and read. Throws Error where the
/// disk takes or gives nothing.
class ScratchFile {
 public:
  ScratchFile();

  /// Adds bytes; their place.
  std::size_t append(std::string_view bytes);
  /// Up to `size` bytes from a place on, fewer at the end of the file.
  [[nodiscard]] std::string read(std::size_t at, std::size_t size) const;

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path folder_;
  FileDescriptor file_;
  std::atomic<std::size_t> size_ = 0;
};

}  // namespace stillmap
