// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/numbered_images.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/image_files.hpp"
#include "stillmap/sensor/image_list.hpp"
#include "stillmap/sensor/pair_images.hpp"
#include "stillmap/sensor/stamps.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// Images with the numbers of their names, not yet seconds.
ImageList by_number(const char* kind, const std::vector<fs::path>& files, const fs::path& folder) {
  if (files.empty()) throw Error("{}: no {} images", folder.string(), kind);
  const std::optional<std::vector<Stamp>> numbers = numbers_in_names(files);
  if (!numbers) {
    throw Error("{}: a name of a {} image has no number; list the pairs in an associations.txt",
                folder.string(),
                kind);
  }
  ImageList list{kind, {}, {}};
  for (std::size_t i = 0; i < files.size(); ++i) list.images.push_back({(*numbers)[i], files[i]});
  const auto key = [](const StampedImage& image) { return image.stamp.seconds; };
  std::ranges::sort(list.images, {}, [&](const StampedImage& image) {
    return std::pair(key(image), image.file);
  });
  const auto twice = std::ranges::adjacent_find(list.images, {}, key);
  if (twice != list.images.end()) {
    throw Error("{} and {}: the same number; list the pairs in an associations.txt",
                twice->file.string(),
                std::next(twice)->file.filename().string());
  }
  return list;
}

std::vector<Stamp> stamps_of(const ImageList& list) {
  std::vector<Stamp> stamps;
  for (const StampedImage& image : list.images) stamps.push_back(image.stamp);
  return stamps;
}

ImageList in_seconds(ImageList list, const ReadingOptions& options) {
  const UnitStamps read = in_seconds(stamps_of(list), options);
  for (std::size_t i = 0; i < list.images.size(); ++i) {
    list.images[i].stamp = stamp_of_seconds(read.stamps[i].seconds);
  }
  return list;
}

// Pairs of equal frame numbers, which the equal stamps are.
PairedImages pair_equal(const ImageList& color, const ImageList& depth, const fs::path& folder) {
  PairedImages paired;
  std::size_t j = 0;
  for (std::size_t i = 0; i < color.images.size(); ++i) {
    const double number = color.images[i].stamp.seconds;
    while (j < depth.images.size() && depth.images[j].stamp.seconds < number) ++j;
    if (j < depth.images.size() && depth.images[j].stamp.seconds == number) {
      paired.pairs.emplace_back(i, j);
    }
  }
  const std::size_t left_out = color.images.size() - paired.pairs.size();
  if (paired.pairs.empty()) {
    throw Error("{}: no colour image has the number of a depth image", folder.string());
  }
  if (left_out > 0) {
    paired.remarks.notes.push_back(
        fmt::format("{} of {} colour images have no depth image of their number and are left out",
                    left_out,
                    color.images.size()));
  }
  return paired;
}

}  // namespace

std::vector<fs::path> files_ending(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool fits = ending.empty() ? has_image_suffix(name) : name.ends_with(ending);
    if (fits && !name.starts_with('.')) files.push_back(at->path());
  }
  if (error) throw Error("cannot read {}: {}", folder.string(), error.message());
  return files;
}

SequenceContent pair_numbered(const std::vector<fs::path>& color,
                              const std::vector<fs::path>& depth,
                              const fs::path& folder,
                              const ReadingOptions& options) {
  const ImageList numbered = by_number("colour", color, folder);
  const ReadingOptions fixed = with_unit_of_names(stamps_of(numbered), options);
  const ImageList colors = in_seconds(numbered, fixed);
  const ImageList depths = in_seconds(by_number("depth", depth, folder), fixed);
  const PairedImages paired = fixed.stamp_unit == StampUnit::kFrames
                                  ? pair_equal(colors, depths, folder)
                                  : pair_by_stamp(colors, depths, folder.string());
  SequenceContent content;
  content.entries = entries_of(paired, colors, depths);
  content.images = read_image_files(content.entries);
  content.remarks = unit_remark("names of images", *fixed.stamp_unit, fixed);
  content.remarks.add(paired.remarks);
  return content;
}

}  // namespace stillmap
