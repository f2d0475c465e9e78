// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/file_moves.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

bool exchange(const fs::path& a, const fs::path& b) {
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

// For file systems that cannot exchange names (FAT, some network ones).
bool exchange_by_renames(const fs::path& from, const fs::path& to) {
  fs::path aside = from;
  aside += ".old";
  if (std::rename(to.c_str(), aside.c_str()) != 0) return false;
  if (std::rename(from.c_str(), to.c_str()) == 0) {
    return std::rename(aside.c_str(), from.c_str()) == 0;
  }
  const int problem = errno;
  (void)std::rename(aside.c_str(), to.c_str());
  errno = problem;
  return false;
}

}  // namespace

void FileMoves::put(const fs::path& from, const fs::path& to, const fs::path& shown) {
  moves_.push_back({from, to, true});  // first, because it may throw
  if (exchange(from, to)) return;
  if (errno == ENOENT) {
    moves_.back().exchanged = false;
    if (std::rename(from.c_str(), to.c_str()) == 0) return;
  } else if ((errno == EINVAL || errno == ENOSYS) && exchange_by_renames(from, to)) {
    return;
  }
  const int problem = errno;
  moves_.pop_back();
  throw Error("cannot write {}: {}", shown.string(), std::generic_category().message(problem));
}

void FileMoves::undo() noexcept {
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
    if (!move->exchanged) {
      (void)std::rename(move->to.c_str(), move->from.c_str());
    } else if (!exchange(move->from, move->to)) {
      (void)std::rename(move->from.c_str(), move->to.c_str());
    }
  }
  moves_.clear();
}

}  // namespace stillmap
