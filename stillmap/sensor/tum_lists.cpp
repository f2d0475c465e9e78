// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/tum_lists.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/groundtruth.hpp"
#include "stillmap/sensor/image_files.hpp"
#include "stillmap/sensor/image_list.hpp"
#include "stillmap/sensor/pair_images.hpp"
#include "stillmap/sensor/stamps.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

using ImagePair = std::pair<ListedImage, ListedImage>;

// The stamps of a list's rows, in seconds, and the rows that count: those that do not repeat the
// stamp before.
struct ListStamps {
  std::vector<Stamp> stamps;
  std::vector<std::size_t> rows;
  Remarks remarks;
};

std::vector<Stamp> stamps_in(const std::vector<ListedImage>& listed) {
  std::vector<Stamp> stamps;
  stamps.reserve(listed.size());
  for (const ListedImage& image : listed) stamps.push_back(image.stamp.value());
  return stamps;
}

ListStamps stamps_of(const fs::path& list,
                     const std::vector<ListedImage>& listed,
                     const ReadingOptions& options) {
  UnitStamps read = in_seconds(stamps_in(listed), options);
  ListStamps result{std::move(read.stamps), {}, {}};
  result.remarks = unit_remark(list.filename().string(), read.unit, options);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const Stamp* const last = result.rows.empty() ? nullptr : &result.stamps[result.rows.back()];
    if (last != nullptr && result.stamps[i].seconds < last->seconds) {
      throw Error("{}: stamp {} does not come after {}, expected increasing stamps",
                  listed[i].place,
                  result.stamps[i].text,
                  last->text);
    }
    if (last == nullptr || result.stamps[i].seconds > last->seconds) result.rows.push_back(i);
  }
  if (result.rows.size() < listed.size()) {
    result.remarks.warnings.push_back(
        fmt::format("{}: {} rows repeat the stamp of the row before and are left out",
                    list.string(),
                    listed.size() - result.rows.size()));
  }
  return result;
}

ImageList read_list(const fs::path& path, const ReadingOptions& options) {
  if (!path_exists(path)) {
    throw Error("{} is missing, expected a sequence in the TUM RGB-D layout", path.string());
  }
  const std::vector<ListedImage> listed = read_image_list(path);
  const ListStamps stamps = stamps_of(path, listed, options);
  ImageList list{path.filename().string(), {}, stamps.remarks};
  list.images.reserve(stamps.rows.size());
  for (const std::size_t i : stamps.rows) {
    list.images.push_back({stamps.stamps[i], listed_file(path.parent_path(), listed[i])});
  }
  return list;
}

// Whether depth comes first in each row: told by the first images that can be read, else by name.
bool depth_first(const fs::path& folder, const std::vector<ImagePair>& pairs) {
  for (const auto& [first, second] : pairs) {
    const bool first_is_depth = is_depth_file(listed_file(folder, first));
    if (first_is_depth != is_depth_file(listed_file(folder, second))) return first_is_depth;
  }
  const auto named_depth = [](const ListedImage& image) {
    return image.name.find("depth") != std::string::npos;
  };
  return named_depth(pairs.front().first) && !named_depth(pairs.front().second);
}

// Gives each image a stamp: its own, else its partner's, else the number in its name, else the
// number of its row. Returns whether the list has stamps.
bool complete_stamps(std::vector<ImagePair>& pairs) {
  std::vector<fs::path> files;
  for (auto& [color, depth] : pairs) {
    if (!color.stamp) color.stamp = depth.stamp;
    if (!depth.stamp) depth.stamp = color.stamp;
    if (!color.stamp) files.emplace_back(color.name);
  }
  if (files.empty()) return true;
  if (files.size() < pairs.size()) {
    const auto bare =
        std::ranges::find_if(pairs, [](const ImagePair& p) { return !p.first.stamp; });
    throw Error("{}: no stamp, but other rows have one", bare->first.place);
  }
  std::optional<std::vector<Stamp>> numbers = numbers_in_names(files);
  const auto seconds = [](const Stamp& stamp) { return stamp.seconds; };
  const bool usable = numbers && std::ranges::adjacent_find(
                                     *numbers, std::greater_equal<>(), seconds) == numbers->end();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Stamp stamp = usable ? (*numbers)[i] : Stamp{static_cast<double>(i), std::to_string(i)};
    pairs[i].first.stamp = pairs[i].second.stamp = stamp;
  }
  return false;
}

// The stamps with the texts of rgb.txt, if all are listed there: other files refer to frames by
// these texts. Otherwise texts could be of two units.
std::vector<Stamp> as_listed(const ImageList& color, const ListStamps& own) {
  const auto seconds = [](const StampedImage& image) { return image.stamp.seconds; };
  std::vector<Stamp> listed = own.stamps;
  for (const std::size_t i : own.rows) {
    const auto found = std::ranges::lower_bound(color.images, listed[i].seconds, {}, seconds);
    if (found == color.images.end() || seconds(*found) != listed[i].seconds) return own.stamps;
    listed[i] = found->stamp;
  }
  return listed;
}

std::vector<ListedImage> color_images(const std::vector<ImagePair>& pairs) {
  std::vector<ListedImage> images;
  for (const ImagePair& pair : pairs) images.push_back(pair.first);
  return images;
}

// `color`: the images of rgb.txt, none where there is no such list.
SequenceContent read_pairs(const fs::path& path,
                           const ImageList& color,
                           const ReadingOptions& options) {
  const fs::path folder = path.parent_path();
  std::vector<ImagePair> pairs = read_image_pairs(path);
  if (depth_first(folder, pairs)) {
    for (auto& [first, second] : pairs) std::swap(first, second);
  }
  const bool listed = complete_stamps(pairs);
  const ReadingOptions own =
      listed ? options : with_unit_of_names(stamps_in(color_images(pairs)), options);
  const ListStamps stamps = stamps_of(path, color_images(pairs), own);
  std::vector<Stamp> depth_stamps;
  for (const ImagePair& pair : pairs) depth_stamps.push_back(pair.second.stamp.value());
  depth_stamps = in_seconds(std::move(depth_stamps), own).stamps;
  SequenceContent content;
  const std::vector<Stamp> texts = as_listed(color, stamps);
  for (const std::size_t i : stamps.rows) {
    const Stamp stamp = listed ? texts[i] : stamp_of_seconds(stamps.stamps[i].seconds);
    content.entries.push_back({stamp,
                               depth_stamps[i].seconds,
                               listed_file(folder, pairs[i].first),
                               listed_file(folder, pairs[i].second)});
  }
  content.remarks = stamps.remarks;
  return content;
}

SequenceContent read_lists(const fs::path& folder,
                           const ImageList& color,
                           const ReadingOptions& options) {
  const ImageList depth = read_list(folder / "depth.txt", options);
  const PairedImages paired = pair_by_stamp(color, depth, folder.string());
  SequenceContent content;
  content.entries = entries_of(paired, color, depth);
  for (const Remarks* remarks : {&color.remarks, &depth.remarks, &paired.remarks}) {
    content.remarks.add(*remarks);
  }
  return content;
}

}  // namespace

fs::path pairs_file(const fs::path& folder) {
  for (const char* name :
       {"associations.txt", "association.txt", "associate.txt", "associated.txt"}) {
    if (path_exists(folder / name)) return folder / name;
  }
  return {};
}

bool is_tum_lists(const fs::path& folder) {
  return path_exists(folder / "rgb.txt") || path_exists(folder / "depth.txt") ||
         !pairs_file(folder).empty();
}

SequenceContent open_tum_lists(const fs::path& folder, const ReadingOptions& options) {
  const fs::path pairs = pairs_file(folder);
  const fs::path rgb = folder / "rgb.txt";
  ImageList color;
  if (pairs.empty() || path_exists(rgb)) color = read_list(rgb, options);
  SequenceContent content =
      pairs.empty() ? read_lists(folder, color, options) : read_pairs(pairs, color, options);
  content.images = read_image_files(content.entries);
  const fs::path poses = folder / "groundtruth.txt";
  if (path_exists(poses)) {
    content.groundtruth = [poses, options] { return read_groundtruth(poses, options); };
  }
  return content;
}

}  // namespace stillmap
