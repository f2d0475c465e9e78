// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

namespace stillmap {

/// Replaces the files of a result in a folder: all of them or none. They are written into a hidden
/// folder beside the old ones, on the disk before anything changes, and take the old ones' places
/// at once: the whole folder is exchanged for one with the new files and all foreign ones. Whoever
/// reads the folder, and whoever is killed, meets the old files or the new ones.
///
/// Where a folder cannot be exchanged (it is a mount point or the working folder, its parent cannot
/// be written to, the file system cannot exchange names or link files, it holds very many foreign
/// files or another user's), the files change places one right after the other, and all go back if
/// one cannot: then only a kill between two of these renames leaves a mixture.
///
/// Files of others in the folder are never lost. All members throw Error, naming the file of the
/// result, on any failure.
class FolderReplacement {
 public:
  /// Whether a file, named relative to the folder, belongs to the result. Files of earlier results
  /// that the new one does not have go.
  using Owns = std::function<bool(const std::filesystem::path& name)>;
  using Sink = std::function<void(std::string_view bytes)>;

  /// Makes the folder if it is missing. Nobody else can replace its files until the destructor.
  FolderReplacement(const std::filesystem::path& folder, Owns owns);
  FolderReplacement(const FolderReplacement&) = delete;
  FolderReplacement& operator=(const FolderReplacement&) = delete;
  /// Removes what has not taken its place.
  ~FolderReplacement();

  /// Writes a file of the new result. `name` is relative to the folder; folders in it are made.
  /// Each name is written once; may be called by several threads.
  void write(const std::filesystem::path& name, std::string_view bytes) const;
  /// Calls `produce` with a function that appends bytes to the file.
  void write(const std::filesystem::path& name,
             const std::function<void(const Sink& sink)>& produce) const;

  /// To be called once, after the last write.
  void take_place();

 private:
  class Stage;
  std::unique_ptr<Stage> stage_;
};

/// Whether a folder has nothing in it, except what an interrupted FolderReplacement has left. True
/// for a folder that does not exist. Throws Error when it cannot be read.
[[nodiscard]] bool is_vacant(const std::filesystem::path& folder);

}  // namespace stillmap
