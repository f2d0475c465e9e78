// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/scratch_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"

namespace stillmap {

ScratchFile::ScratchFile() {
  std::error_code unusable;
  folder_ = std::filesystem::temp_directory_path(unusable);
  if (unusable) folder_ = "/tmp";
  file_ = FileDescriptor(::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (file_.get() >= 0) return;
  // Not every file system has such files: then the name goes at once.
  std::string name = (folder_ / "stillmap-XXXXXX").string();
  file_ = FileDescriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (file_.get() < 0) fail("make");
  ::unlink(name.c_str());
}

std::size_t ScratchFile::append(std::string_view bytes) {
  const std::size_t place = size_.fetch_add(bytes.size());
  for (std::size_t at = place; !bytes.empty();) {
    const ssize_t written =
        ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write");
    at += static_cast<std::size_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return place;
}

std::string ScratchFile::read(std::size_t at, std::size_t size) const {
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got =
        ::pread(file_.get(), bytes.data() + have, size - have, static_cast<off_t>(at + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read");
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

void ScratchFile::fail(const char* what) const {
  throw Error("cannot {} a temporary file in {}: {}; TMPDIR may name another folder",
              what,
              folder_.string(),
              error_text(errno));
}

}  // namespace stillmap
