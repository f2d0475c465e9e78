// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// Writes a whole file or leaves it unchanged: the bytes go to a temporary file in the same folder,
/// which is renamed; where it replaces another, once they are on the disk. A reader of `path` sees
/// the old content or the new one, never a part. A link is followed; a device (/dev/stdout) is
/// written directly. Throws Error on any failure (no such folder, not writable, disk full) and
/// leaves no temporary file.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

class FileMoves;

struct FileContent {
  std::filesystem::path path;
  std::string bytes;
};

/// Writes several files, all of them or none: all bytes go to temporary files in the folders of the
/// files, which are renamed, one right after the other, once all are complete; if a rename fails,
/// the earlier ones are taken back. Throws Error as write_file_atomically does, and for a device.
void write_files_atomically(std::span<const FileContent> files);

/// Writes a file piece by piece, and atomically. Until it takes its place there is only a temporary
/// file, which the destructor removes. All members throw Error as write_file_atomically does.
class AtomicFile {
 public:
  /// Throws Error for a device, too.
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);
  /// After the last write.
  void close();
  /// After close().
  void take_place();
  /// The same, together with other moves. The object outlives `moves`.
  void take_place(FileMoves& moves);

 private:
  class Replacement;
  std::unique_ptr<Replacement> replacement_;
};

/// The whole content of a file. Throws Error when the file cannot be read, is a folder, or has more
/// than `max_bytes`, of which no more is allocated.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Whether `path` exists; false also when that cannot be determined (no permission).
[[nodiscard]] bool path_exists(const std::filesystem::path& path);

}  // namespace stillmap
