// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/folder_replacement.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/file_descriptor.hpp"
#include "stillmap/io/file_moves.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStageName = ".stillmap-new";
constexpr std::size_t kMostForeign = 20000;  // more would take long to link

// Of the file itself where it is a link; without a mode where there is none.
struct stat status_of(const fs::path& path) {
  struct stat status = {};
  return ::lstat(path.c_str(), &status) == 0 ? status : decltype(status){};
}

bool is_same_file(const struct stat& a, const struct stat& b) {
  return a.st_mode != 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

bool is_older(const struct stat& a, const struct stat& b) {
  return a.st_mtim.tv_sec != b.st_mtim.tv_sec ? a.st_mtim.tv_sec < b.st_mtim.tv_sec
                                              : a.st_mtim.tv_nsec < b.st_mtim.tv_nsec;
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder, failure)) {
    throw Error("{}: the folder cannot be made ({}); name one in a place that can be written to",
                folder.string(),
                failure ? failure.message() : "a file has its name");
  }
}

// What is in a folder and below, named relative to it, the content of a folder after the folder.
// Links are not followed.
struct Listing {
  std::vector<fs::path> files, folders;
  bool complete = true;  ///< nothing could not be read
};

Listing list_folder(const fs::path& folder) {
  Listing listing;
  std::error_code failure;
  fs::recursive_directory_iterator entries(folder, failure);
  for (; !failure && entries != fs::recursive_directory_iterator(); entries.increment(failure)) {
    const fs::path name = entries->path().lexically_relative(folder);
    if (name == kStageName) {
      entries.disable_recursion_pending();
      continue;
    }
    const bool is_folder = fs::is_directory(entries->symlink_status(failure));
    (is_folder ? listing.folders : listing.files).push_back(name);
  }
  listing.complete = !failure;
  std::ranges::sort(listing.files);
  return listing;
}

// Removes the files of the result and the links of foreign files from a folder that was replaced or
// given up, and then the folder. A foreign file that `kept` has not, or has in an older version,
// moves there.
void settle(const fs::path& folder, const fs::path& kept, const FolderReplacement::Owns& owns) {
  const Listing listing = list_folder(folder);
  for (const fs::path& name : listing.files) {
    const struct stat here = status_of(folder / name), there = status_of(kept / name);
    const bool wanted =
        !owns(name) && !is_same_file(here, there) && (there.st_mode == 0 || is_older(there, here));
    if (!wanted) {
      ::unlink((folder / name).c_str());
    } else {
      std::error_code ignored;
      fs::create_directories((kept / name).parent_path(), ignored);
      (void)::rename((folder / name).c_str(), (kept / name).c_str());
    }
  }
  // A folder in which something is left stays.
  for (auto name = listing.folders.rbegin(); name != listing.folders.rend(); ++name) {
    ::rmdir((folder / *name).c_str());
  }
  ::rmdir(folder.c_str());
}

// Opens a folder and locks it until the descriptor is closed, at the latest by the end of the
// process; nothing if it is locked or not there.
std::optional<FileDescriptor> lock_folder(const fs::path& folder) {
  FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() < 0) return std::nullopt;
  // Where the file system has no locks there are none.
  if (::flock(opened.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return std::nullopt;
  return opened;
}

}  // namespace

class FolderReplacement::Stage {
 public:
  Stage(const fs::path& folder, Owns owns);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  ~Stage() { settle(staged_, target_, owns_); }

  void write(const fs::path& name, const std::function<void(const Sink&)>& produce) const;
  void take_place();

 private:
  void flush(const Listing& written) const;
  [[nodiscard]] bool exchange(const Listing& old) const;
  [[nodiscard]] bool may_exchange(const Listing& old) const;
  [[nodiscard]] bool link_foreign(const Listing& old) const;
  void replace_one_by_one(const Listing& written, const Listing& old) const;
  [[noreturn]] void fail(const fs::path& name, int error_number) const {
    throw Error("cannot write {}: {}", (shown_ / name).string(), error_text(error_number));
  }

  fs::path shown_;    // as the user calls the folder
  fs::path target_;   // without links
  fs::path staged_;   // the new files, in the folder
  fs::path sibling_;  // where they wait for the exchange
  Owns owns_;
  std::optional<FileDescriptor> lock_;
};

FolderReplacement::Stage::Stage(const fs::path& folder, Owns owns)
    : shown_(folder), owns_(std::move(owns)) {
  make_folder(folder);
  std::error_code failure;
  target_ = fs::canonical(folder, failure);
  if (failure) throw Error("{}: {}", folder.string(), failure.message());
  staged_ = target_ / kStageName;
  sibling_ = target_.parent_path() / fmt::format(".{}{}", target_.filename().string(), kStageName);
  for (const fs::path& left : {sibling_, staged_}) {  // by a process that was killed
    if (const std::optional<FileDescriptor> locked = lock_folder(left))
      settle(left, target_, owns_);
  }
  const bool made = ::mkdir(staged_.c_str(), 0777) == 0;
  if (!made && errno != EEXIST) fail("", errno);
  if (made) lock_ = lock_folder(staged_);
  if (!lock_) {
    throw Error("{}: another process is writing results into this folder", shown_.string());
  }
}

void FolderReplacement::Stage::write(const fs::path& name,
                                     const std::function<void(const Sink&)>& produce) const {
  const fs::path path = staged_ / name, shown = shown_ / name;
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  if (failure) throw Error("cannot write {}: {}", shown.string(), failure.message());
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) fail(name, errno);
  produce([&](std::string_view bytes) { write_all(file, bytes, shown); });
  close_written(file, false, shown);
}

void FolderReplacement::Stage::take_place() {
  const Listing written = list_folder(staged_);
  for (const fs::path& name : written.files) {
    if (S_ISDIR(status_of(target_ / name).st_mode)) fail(name, EISDIR);
  }
  flush(written);
  const Listing old = list_folder(target_);
  if (!exchange(old)) replace_one_by_one(written, old);
}

// One call for a whole file system takes less time than a call for each of many files, and more
// than for a few.
void FolderReplacement::Stage::flush(const Listing& written) const {
  constexpr std::size_t kMany = 64;
  if (written.files.size() > kMany) {
    if (::syncfs(lock_->get()) != 0) fail("", errno);
    return;
  }
  for (const fs::path& name : written.files) {
    FileDescriptor file(::open((staged_ / name).c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) fail(name, errno);
    close_written(file, true, shown_ / name);
  }
}

// The working folder would remain the old one, a mount point cannot be renamed, and the new folder
// would belong to another user.
bool FolderReplacement::Stage::may_exchange(const Listing& old) const {
  std::error_code failure;
  const fs::path working = fs::current_path(failure);
  const bool is_working = std::ranges::mismatch(target_, working).in1 == target_.end();
  return !failure && !is_working && old.complete && old.files.size() < kMostForeign &&
         status_of(target_).st_uid == ::geteuid();
}

bool FolderReplacement::Stage::link_foreign(const Listing& old) const {
  const struct stat folder = status_of(target_);
  if (::chown(staged_.c_str(), static_cast<uid_t>(-1), folder.st_gid) != 0) return false;
  if (::chmod(staged_.c_str(), folder.st_mode & 07777U) != 0) return false;
  for (const fs::path& name : old.folders) {
    if (::mkdir((staged_ / name).c_str(), 0777) != 0 && errno != EEXIST) return false;
    (void)::chmod((staged_ / name).c_str(), status_of(target_ / name).st_mode & 07777U);
  }
  return std::ranges::all_of(old.files, [&](const fs::path& name) {
    return owns_(name) || ::link((target_ / name).c_str(), (staged_ / name).c_str()) == 0;
  });
}

// Whether the folder was exchanged for the new one.
bool FolderReplacement::Stage::exchange(const Listing& old) const {
  if (!may_exchange(old) || !link_foreign(old)) return false;
  if (::rename(staged_.c_str(), sibling_.c_str()) != 0) return false;
  if (::renameat2(AT_FDCWD, sibling_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) {
    const int problem = errno;
    if (::rename(sibling_.c_str(), staged_.c_str()) != 0) fail("", problem);
    return false;
  }
  settle(sibling_, target_, owns_);
  return true;
}

void FolderReplacement::Stage::replace_one_by_one(const Listing& written,
                                                  const Listing& old) const {
  std::error_code failure;
  for (const fs::path& name : written.folders) {
    fs::create_directories(target_ / name, failure);
    if (failure) fail(name, failure.value());
  }
  FileMoves moves;
  for (const fs::path& name : written.files) {
    moves.put(staged_ / name, target_ / name, shown_ / name);
  }
  for (const fs::path& name : old.files) {
    const bool gone = owns_(name) && !std::ranges::binary_search(written.files, name);
    if (!gone) continue;
    fs::create_directories((staged_ / name).parent_path(), failure);
    moves.put(target_ / name, staged_ / name, shown_ / name);
  }
  moves.keep();
}

FolderReplacement::FolderReplacement(const fs::path& folder, Owns owns)
    : stage_(std::make_unique<Stage>(folder, std::move(owns))) {}

FolderReplacement::~FolderReplacement() = default;

void FolderReplacement::write(const fs::path& name, std::string_view bytes) const {
  stage_->write(name, [&](const Sink& sink) { sink(bytes); });
}

void FolderReplacement::write(const fs::path& name,
                              const std::function<void(const Sink&)>& produce) const {
  stage_->write(name, produce);
}

void FolderReplacement::take_place() {
  stage_->take_place();
}

bool is_vacant(const fs::path& folder) {
  std::error_code failure;
  fs::directory_iterator entries(folder, failure);
  if (failure == std::errc::no_such_file_or_directory) return true;
  if (failure) throw Error("{}: cannot be read ({})", folder.string(), failure.message());
  return std::all_of(entries, fs::directory_iterator(), [](const fs::directory_entry& entry) {
    return entry.path().filename() == kStageName;
  });
}

}  // namespace stillmap
