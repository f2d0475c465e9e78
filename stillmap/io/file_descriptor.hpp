// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace stillmap {

/// A file descriptor that its destructor closes.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor();

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] int close();

 private:
  int fd_;
};

/// The text of an error number.
[[nodiscard]] std::string error_text(int error_number);

/// Writes all bytes. Messages call the file `shown`.
void write_all(const FileDescriptor& file,
               std::string_view bytes,
               const std::filesystem::path& shown);

/// Closes the file, where `flush` once its bytes are on the disk.
void close_written(FileDescriptor& file, bool flush, const std::filesystem::path& shown);

}  // namespace stillmap
