// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/atomic_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <deque>
#include <memory>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/file_descriptor.hpp"
#include "stillmap/io/file_moves.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// Removes a temporary file: one that was not renamed, or the old content of a file.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { ::unlink(path_.c_str()); }

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void write_directly(const fs::path& path, std::string_view bytes) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) throw Error("cannot write {}: {}", path.string(), error_text(errno));
  write_all(file, bytes, path);
  close_written(file, false, path);
}

struct OpenTemporary {
  FileDescriptor file;
  fs::path path;
};

// A new file beside `path`. Its name has the process id and a number that this process has not used
// yet: the name stays this file's after the file has moved. Leftovers of a killed process are
// passed over.
OpenTemporary open_temporary(const fs::path& path) {
  static std::atomic<unsigned> next{0};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    fs::path name = path;
    name += fmt::format(".tmp{}-{}", ::getpid(), next++);
    FileDescriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() >= 0) return {std::move(file), std::move(name)};
    if (errno != EEXIST) throw Error("cannot write {}: {}", path.string(), error_text(errno));
  }
  throw Error("cannot write {}: too many temporary files beside it; remove {}.tmp*",
              path.string(),
              path.string());
}

// The file that is written: the target of a link.
fs::path checked_target(const fs::path& path) {
  std::error_code ignored;
  const fs::path target =
      fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
  if (target.empty()) throw Error("cannot write a file without a name");
  if (fs::is_directory(target, ignored)) {
    throw Error("cannot write {}: it is a folder", path.string());
  }
  return target;
}

bool is_device(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

// The new content of a file in a temporary file.
class AtomicFile::Replacement {
 public:
  Replacement(fs::path asked_for, fs::path target)
      : asked_for_(std::move(asked_for)),
        target_(std::move(target)),
        opened_(open_temporary(target_)),
        temporary_(opened_.path) {}

  void write(std::string_view bytes) { write_all(opened_.file, bytes, asked_for_); }
  // Where nothing is replaced, a power failure loses nothing that was there.
  void close() { close_written(opened_.file, path_exists(target_), asked_for_); }

  void take_place() {
    if (::rename(temporary_.path().c_str(), target_.c_str()) != 0) {
      throw Error("cannot write {}: {}", asked_for_.string(), error_text(errno));
    }
  }
  void take_place(FileMoves& moves) { moves.put(temporary_.path(), target_, asked_for_); }

 private:
  fs::path asked_for_;
  fs::path target_;
  OpenTemporary opened_;
  TemporaryFile temporary_;
};

AtomicFile::AtomicFile(const fs::path& path) {
  const fs::path target = checked_target(path);
  if (is_device(target)) throw Error("cannot write {}: it is a device", path.string());
  replacement_ = std::make_unique<Replacement>(path, target);
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::string_view bytes) {
  replacement_->write(bytes);
}

void AtomicFile::close() {
  replacement_->close();
}

void AtomicFile::take_place() {
  replacement_->take_place();
}

void AtomicFile::take_place(FileMoves& moves) {
  replacement_->take_place(moves);
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  const fs::path target = checked_target(path);
  if (is_device(target)) return write_directly(target, bytes);
  AtomicFile file(path);
  file.write(bytes);
  file.close();
  file.take_place();
}

void write_files_atomically(std::span<const FileContent> files) {
  std::deque<AtomicFile> replacements;
  for (const FileContent& file : files) {
    AtomicFile& replacement = replacements.emplace_back(file.path);
    replacement.write(file.bytes);
    replacement.close();
  }
  FileMoves moves;  // after the files, so that they take their places back before these go
  for (AtomicFile& replacement : replacements) replacement.take_place(moves);
  moves.keep();
}

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) throw Error("cannot read {}: {}", path.string(), error_text(errno));
  struct stat status = {};
  if (::fstat(file.get(), &status) != 0) {
    throw Error("cannot read {}: {}", path.string(), error_text(errno));
  }
  if (S_ISDIR(status.st_mode)) throw Error("cannot read {}: it is a folder", path.string());
  const std::size_t expected = static_cast<std::size_t>(std::max<off_t>(status.st_size, 0));

  // Reading one byte more than the size finds the end of the file with the same call. Pipes and
  // /proc report size 0 and are read in growing steps.
  std::string content(std::min(expected, max_bytes) + 1, '\0');
  std::size_t size = 0;
  while (size <= max_bytes) {
    if (size == content.size()) content.resize(std::max<std::size_t>(2 * size, 65536));
    const ssize_t count = ::read(file.get(), content.data() + size, content.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error("cannot read {}: {}", path.string(), error_text(errno));
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  if (size > max_bytes) {
    throw Error("{} is larger than {} bytes, the most that is read", path.string(), max_bytes);
  }
  content.resize(size);
  return content;
}

bool path_exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

}  // namespace stillmap
