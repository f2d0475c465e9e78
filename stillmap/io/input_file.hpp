// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace stillmap {

/// A regular file, open for reading in parts.
class InputFile {
 public:
  /// Throws Error when the file cannot be read or is no regular file.
  explicit InputFile(const std::filesystem::path& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// The size when the file was opened, bytes.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns `size` bytes from `offset` on. Throws Error when reading fails or the file has become
  /// shorter.
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t size) const;

 private:
  std::filesystem::path path_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace stillmap
