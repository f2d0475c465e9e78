// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/image_folders.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "stillmap/core/ascii_lower.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/intrinsic_files.hpp"
#include "stillmap/sensor/numbered_images.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (at->is_directory(ignored)) found.push_back(at->path());
  }
  std::ranges::sort(found);
  return found;
}

// The folder with one of the names, the first name first, else the only one with a word in its
// name.
fs::path choose(const std::vector<fs::path>& folders,
                const std::vector<std::string>& names,
                const std::vector<std::string>& words) {
  for (const std::string& name : names) {
    for (const fs::path& folder : folders) {
      if (ascii_lower(folder.filename().string()) == name) return folder;
    }
  }
  fs::path only;
  for (const fs::path& folder : folders) {
    const std::string name = ascii_lower(folder.filename().string());
    const bool fits = std::ranges::any_of(
        words, [&](const std::string& word) { return name.find(word) != std::string::npos; });
    if (!fits) continue;
    if (!only.empty()) return {};
    only = folder;
  }
  return only;
}

// The files beside the folders with that ending, in the order of their names.
std::vector<fs::path> files_beside(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> files = files_ending(folder, ending);
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::optional<ImageFolders> find_image_folders(const fs::path& folder) {
  const std::vector<fs::path> folders = subfolders(folder);
  ImageFolders found;
  found.depth = choose(folders, {"depth"}, {"depth"});
  std::vector<fs::path> others;
  std::ranges::copy_if(folders, std::back_inserter(others), [](const fs::path& path) {
    return ascii_lower(path.filename().string()).find("depth") == std::string::npos;
  });
  found.color = choose(others, {"color", "rgb", "image", "images"}, {"color", "rgb"});
  if (found.color.empty() || found.depth.empty()) return std::nullopt;
  return found;
}

bool is_image_folders(const fs::path& folder) {
  return find_image_folders(folder).has_value();
}

SequenceContent open_image_folders(const fs::path& folder, const ReadingOptions& options) {
  const std::optional<ImageFolders> folders = find_image_folders(folder);
  if (!folders) throw Error("{}: no folders color and depth in it", folder.string());
  std::optional<CameraModel> camera;
  for (const fs::path& json : files_beside(folder, ".json")) {
    if (camera = read_intrinsic_json(json); camera) break;
  }
  const std::vector<fs::path> colors = files_ending(folders->color, "");
  SequenceContent content =
      pair_numbered(colors, files_ending(folders->depth, ""), folder, options);
  content.camera = camera;
  const std::vector<fs::path> logs = files_beside(folder, ".log");
  const fs::path poses = folder / "groundtruth.txt";
  if (path_exists(poses)) {
    content.groundtruth = [poses, options] { return read_groundtruth(poses, options); };
  } else if (!logs.empty()) {
    const bool all_paired = colors.size() == content.entries.size();
    content.groundtruth = [log = logs.front(), entries = content.entries, all_paired] {
      if (all_paired) return read_pose_log(log, entries);
      return GroundTruth{{},
                         {fmt::format("no ground truth: {} counts colour images, of which some "
                                      "have no depth image",
                                      log.string())}};
    };
  }
  return content;
}

}  // namespace stillmap
