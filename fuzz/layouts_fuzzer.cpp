// SPDX-License-Identifier: Apache-2.0
// Any small files in a folder: each reader of a layout that recognises the folder refuses it, or
// gives frames in order, of files without `..` in their names, and true poses in order.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fuzz/harness.hpp"
#include "stillmap/sensor/sequence_formats.hpp"
#include "tooling/recordings/euroc.hpp"
#include "tooling/recordings/kitti.hpp"

namespace stillmap::fuzz {
namespace {

constexpr std::size_t kMostFiles = 12;
constexpr std::size_t kMostName = 80;

// Whether a name stays in the folder, and no part of it is longer than file systems take.
bool is_usable(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' ||
           c == '/';
  };
  return !name.empty() && name.size() <= kMostName && std::ranges::all_of(name, fits) &&
         name.front() != '/' && name.back() != '/' && name.find("..") == std::string_view::npos &&
         name.find("./") == std::string_view::npos && name.find("//") == std::string_view::npos;
}

// Parts that begin with a line of a name become files of that name.
void fill(const MemoryFolder& folder, std::string_view bytes) {
  std::error_code ignored;  // a name may be that of a folder already
  for (const std::string_view part : parts_of(bytes, kMostFiles)) {
    const std::size_t end = part.find('\n');
    const std::string name(part.substr(0, end));
    if (end == std::string_view::npos || !is_usable(name)) continue;
    const std::filesystem::path path = folder.path() / name;
    std::filesystem::create_directories(path.parent_path(), ignored);
    if (ignored || std::filesystem::is_directory(path, ignored)) continue;
    (void)folder.put(name.c_str(), part.substr(end + 1));
  }
}

void check(const SequenceContent& content) {
  const std::vector<SequenceEntry>& entries = content.entries;
  require(!entries.empty() && content.images != nullptr, "there are frames");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    require(std::isfinite(entries[i].stamp.seconds), "a stamp");
    require(i == 0 || entries[i - 1].stamp.seconds < entries[i].stamp.seconds, "in order");
    for (const auto& file : {entries[i].color_file, entries[i].depth_file}) {
      require(std::ranges::find(file, "..") == file.end(), "no way up");
    }
  }
  if (!content.groundtruth) return;
  const Trajectory poses = content.groundtruth().poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require(i == 0 || poses[i - 1].stamp.seconds < poses[i].stamp.seconds, "poses in order");
    require(poses[i].T_world_camera.matrix().allFinite(), "finite poses");
  }
}

void read(std::string_view bytes) {
  const MemoryFolder folder;  // a new one each time, so that no file of an earlier input is in it
  fill(folder, bytes);
  std::vector<SequenceFormat> formats(folder_formats().begin(), folder_formats().end());
  formats.push_back({"euroc", "", is_euroc, open_euroc});
  formats.push_back({"kitti", "", is_kitti, open_kitti});
  for (const SequenceFormat& format : formats) {
    read_or_refuse([&] {
      if (format.recognized(folder.path())) check(format.open(folder.path(), {}));
    });
  }
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
