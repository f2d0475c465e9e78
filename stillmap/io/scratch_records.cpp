// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/scratch_records.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "stillmap/core/append_bytes.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/descriptor.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kBuffer = 64U << 10U;
constexpr std::size_t kSizeBytes = sizeof(std::uint32_t);

// Visits the whole records at the beginning of `bytes` and removes them.
void take_whole(std::string& bytes, const std::function<void(std::string_view)>& visit) {
  std::string_view rest = bytes;
  while (rest.size() >= kSizeBytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, rest.data(), kSizeBytes);
    if (size > rest.size() - kSizeBytes) break;
    visit(rest.substr(kSizeBytes, size));
    rest.remove_prefix(kSizeBytes + size);
  }
  bytes.erase(0, bytes.size() - rest.size());
}

}  // namespace

/// A file without a name.
class ScratchRecords::File {
 public:
  File() {
    std::error_code unusable;
    folder_ = std::filesystem::temp_directory_path(unusable);
    if (unusable) folder_ = "/tmp";
    file_ = Descriptor(::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (file_.get() >= 0) return;
    // Not every file system has such files: then the name goes at once.
    std::string name = (folder_ / "stillmap-XXXXXX").string();
    file_ = Descriptor(::mkostemp(name.data(), O_CLOEXEC));
    if (file_.get() < 0) fail("make");
    ::unlink(name.c_str());
  }

  void append(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  /// Up to kBuffer bytes from a position on; none at the end.
  [[nodiscard]] std::string read(std::size_t at) const {
    std::string bytes(kBuffer, '\0');
    ssize_t size = -1;
    do {
      size = ::pread(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    } while (size < 0 && errno == EINTR);
    if (size < 0) fail("read");
    bytes.resize(static_cast<std::size_t>(size));
    return bytes;
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw Error("cannot {} a temporary file in {}: {}; TMPDIR may name another folder",
                what,
                folder_.string(),
                error_text(errno));
  }

  std::filesystem::path folder_;
  Descriptor file_;
};

ScratchRecords::ScratchRecords() = default;
ScratchRecords::~ScratchRecords() = default;

void ScratchRecords::push_back(std::string_view record) {
  STILLMAP_CHECK(record.size() <= std::numeric_limits<std::uint32_t>::max());
  append_bytes(buffer_, static_cast<std::uint32_t>(record.size()));
  buffer_ += record;
  if (buffer_.size() < kBuffer) return;
  if (!file_) file_ = std::make_unique<File>();
  file_->append(buffer_);
  buffer_.clear();
}

void ScratchRecords::visit(const std::function<void(std::string_view record)>& visit) const {
  std::string bytes;
  for (std::size_t at = 0; file_;) {
    const std::string piece = file_->read(at);
    if (piece.empty()) break;
    at += piece.size();
    bytes += piece;
    take_whole(bytes, visit);
  }
  bytes += buffer_;
  take_whole(bytes, visit);
  STILLMAP_CHECK(bytes.empty());
}

}  // namespace stillmap
