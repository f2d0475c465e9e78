// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/input_file.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

Error read_error(const std::filesystem::path& path, int error_number) {
  return Error("cannot read {}: {}", path.string(), std::generic_category().message(error_number));
}

}  // namespace

// Non-blocking, because opening a pipe would wait for its writer.
InputFile::InputFile(const std::filesystem::path& path)
    : path_(path), fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (fd_ < 0) throw read_error(path, errno);
  struct stat status = {};
  const bool known = ::fstat(fd_, &status) == 0;
  const int problem = known ? 0 : errno;
  if (!known || !S_ISREG(status.st_mode)) ::close(fd_);
  if (!known) throw read_error(path, problem);
  if (S_ISDIR(status.st_mode)) throw Error("cannot read {}: it is a folder", path.string());
  if (!S_ISREG(status.st_mode)) throw Error("cannot read {}: it is no file", path.string());
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  ::close(fd_);
}

std::string InputFile::read(std::uint64_t offset, std::size_t size) const {
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count =
        ::pread(fd_, bytes.data() + done, size - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw read_error(path_, errno);
    if (count == 0) throw Error("cannot read {}: it has become shorter", path_.string());
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace stillmap
