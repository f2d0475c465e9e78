// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/file_descriptor.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include <unistd.h>

#include "stillmap/core/error.hpp"

namespace stillmap {

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

int FileDescriptor::close() {
  return ::close(std::exchange(fd_, -1));
}

std::string error_text(int error_number) {
  return std::generic_category().message(error_number);
}

void write_all(const FileDescriptor& file,
               std::string_view bytes,
               const std::filesystem::path& shown) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error("cannot write {}: {}", shown.string(), error_text(errno));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

// Devices and some file systems have nothing to flush.
void close_written(FileDescriptor& file, bool flush, const std::filesystem::path& shown) {
  const bool flushed =
      !flush || ::fsync(file.get()) == 0 || errno == EINVAL || errno == ENOSYS || errno == EROFS;
  const int problem = errno;
  const bool closed = file.close() == 0;
  if (!flushed) throw Error("cannot write {}: {}", shown.string(), error_text(problem));
  if (!closed) throw Error("cannot write {}: {}", shown.string(), error_text(errno));
}

}  // namespace stillmap
