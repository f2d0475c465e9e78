// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace stillmap {

/// Several renames that happen together: until keep() is called, the destructor takes all of them
/// back, the last first.
class FileMoves {
 public:
  FileMoves() = default;
  FileMoves(const FileMoves&) = delete;
  FileMoves& operator=(const FileMoves&) = delete;
  ~FileMoves() { undo(); }

  /// Moves the file `from` to the place of `to`, on the same file system. A file that is there
  /// moves to `from`; nobody ever sees `to` missing where the file system can exchange names.
  /// Throws Error, naming `shown`, on failure; then this move did not happen.
  void put(const std::filesystem::path& from,
           const std::filesystem::path& to,
           const std::filesystem::path& shown);

  /// Makes the moves final.
  void keep() { moves_.clear(); }

 private:
  struct Move {
    std::filesystem::path from, to;
    bool exchanged = false;  ///< `from` holds what was at `to`
  };
  void undo() noexcept;

  std::vector<Move> moves_;
};

}  // namespace stillmap
