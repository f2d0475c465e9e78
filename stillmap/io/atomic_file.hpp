// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// Writes a whole file or leaves it as it was: the bytes go to a temporary name in the same folder,
/// which then takes the file's name. Whatever reads `path` sees the old content or the new one,
/// never a part. A link is followed; a device (/dev/stdout) is written directly. Throws Error when
/// anything fails (no such folder, not writable, disk full), and leaves no temporary file.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

struct FileContent {
  std::filesystem::path path;
  std::string bytes;
};

/// Writes several files, all of them or none: all bytes go to temporary names in the files' own
/// folders, and only when all are there the names are taken, one after the other. Throws Error as
/// write_file_atomically does, and for a device.
void write_files_atomically(std::span<const FileContent> files);

/// The same for a file that is written piece by piece. Until it takes its place, only a temporary
/// file is there, which goes with this. All throw Error as write_file_atomically does.
class AtomicFile {
 public:
  /// Throws Error for a device too.
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);
  /// After the last write.
  void close();
  /// After close().
  void take_place();

 private:
  class Replacement;
  std::unique_ptr<Replacement> replacement_;
};

/// The whole content of a file. Throws Error when it cannot be read, is a folder, or is larger than
/// `max_bytes`, before that much is allocated.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Whether something is at `path`; false also where that cannot be told (no permission).
[[nodiscard]] bool path_exists(const std::filesystem::path& path);

}  // namespace stillmap
