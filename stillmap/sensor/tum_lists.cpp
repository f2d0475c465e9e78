// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/tum_lists.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/text_table.hpp"
#include "stillmap/sensor/associate.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct ListedImage {
  Stamp stamp;
  fs::path file;
};

// A sequence may come from an untrusted source: its lists must not reach files outside its folder.
fs::path listed_file(const fs::path& folder,
                     const TextTable& table,
                     const TextRow& row,
                     std::size_t column) {
  const fs::path listed(row.columns.at(column));
  const bool upwards = std::ranges::find(listed, fs::path("..")) != listed.end();
  if (listed.is_absolute() || upwards) {
    throw Error("{}: '{}' leads out of the sequence, expected a file below its folder",
                table.place(row),
                listed.string());
  }
  return folder / listed;
}

void check_increasing(const Stamp* previous, const Stamp& stamp, const std::string& place) {
  if (previous == nullptr || stamp.seconds > previous->seconds) return;
  throw Error("{}: stamp {} does not come after {}, expected increasing stamps",
              place,
              stamp.text,
              previous->text);
}

void check_not_empty(const TextTable& table, const fs::path& path) {
  if (table.rows().empty()) throw Error("{}: the list is empty", path.string());
}

std::vector<ListedImage> read_list(const fs::path& folder, std::string_view name) {
  const fs::path path = folder / name;
  if (!path_exists(path)) {
    throw Error("{} is missing, expected a sequence in the TUM RGB-D layout", path.string());
  }
  const TextTable table = TextTable::read(path, "stamp file");
  check_not_empty(table, path);
  std::vector<ListedImage> images;
  images.reserve(table.rows().size());
  for (const TextRow& row : table.rows()) {
    Stamp stamp = table.stamp(row, 0);
    check_increasing(images.empty() ? nullptr : &images.back().stamp, stamp, table.place(row));
    images.push_back({std::move(stamp), listed_file(folder, table, row, 1)});
  }
  return images;
}

// The stamp with the text of rgb.txt, if listed there: other files refer to a frame by that text.
Stamp stamp_as_listed(const std::vector<ListedImage>& images, const Stamp& stamp) {
  const auto seconds = [](const ListedImage& image) { return image.stamp.seconds; };
  const auto found = std::ranges::lower_bound(images, stamp.seconds, {}, seconds);
  return found != images.end() && seconds(*found) == stamp.seconds ? found->stamp : stamp;
}

std::vector<SequenceEntry> read_associations(const fs::path& folder,
                                             const std::vector<ListedImage>& color) {
  const fs::path path = folder / "associations.txt";
  const TextTable table = TextTable::read(path, "stamp_rgb file_rgb stamp_depth file_depth");
  check_not_empty(table, path);
  std::vector<SequenceEntry> entries;
  entries.reserve(table.rows().size());
  for (const TextRow& row : table.rows()) {
    const Stamp stamp = table.stamp(row, 0);
    check_increasing(entries.empty() ? nullptr : &entries.back().stamp, stamp, table.place(row));
    entries.push_back({stamp_as_listed(color, stamp),
                       table.number(row, 2),
                       listed_file(folder, table, row, 1),
                       listed_file(folder, table, row, 3)});
  }
  return entries;
}

std::vector<double> seconds_of(const std::vector<ListedImage>& images) {
  std::vector<double> seconds;
  seconds.reserve(images.size());
  for (const ListedImage& image : images) seconds.push_back(image.stamp.seconds);
  return seconds;
}

std::vector<SequenceEntry> pair_by_stamp(const fs::path& folder,
                                         const std::vector<ListedImage>& color) {
  const std::vector<ListedImage> depth = read_list(folder, "depth.txt");
  std::vector<SequenceEntry> entries;
  for (const auto& [i, j] : associate(seconds_of(color), seconds_of(depth), kMaxStampDifferenceS)) {
    entries.push_back({color[i].stamp, depth[j].stamp.seconds, color[i].file, depth[j].file});
  }
  if (entries.empty()) {
    throw Error("{}: no stamp of rgb.txt is within {} s of one of depth.txt",
                folder.string(),
                kMaxStampDifferenceS);
  }
  return entries;
}

}  // namespace

std::vector<SequenceEntry> read_sequence_entries(const fs::path& folder) {
  const std::vector<ListedImage> color = read_list(folder, "rgb.txt");
  const bool associated = path_exists(folder / "associations.txt");
  return associated ? read_associations(folder, color) : pair_by_stamp(folder, color);
}

}  // namespace stillmap
