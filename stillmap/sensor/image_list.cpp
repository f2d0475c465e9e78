// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/image_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "stillmap/core/ascii_lower.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/io/text_file.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = std::size_t{64} << 20U;
constexpr std::size_t kMaxRows = 2'000'000;
constexpr std::string_view kBlanks = " \t\r";

// A part of a row between blanks, or between quotation marks.
struct Word {
  std::size_t begin = 0, end = 0;  // in the row, without the marks
  bool quoted = false;
};

std::vector<Word> words_of(std::string_view row) {
  std::vector<Word> words;
  std::size_t at = row.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t closing = row[at] == '"' ? row.find('"', at + 1) : std::string_view::npos;
    Word word{at + 1, closing, true};
    if (closing == std::string_view::npos) {
      word = {at, std::min(row.find_first_of(kBlanks, at), row.size()), false};
    }
    words.push_back(word);
    at = row.find_first_not_of(kBlanks, word.end + (word.quoted ? 1 : 0));
  }
  return words;
}

std::string_view text_of(std::string_view row, const Word& word) {
  return row.substr(word.begin, word.end - word.begin);
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc::invalid_argument || end != text.data() + text.size()) {
    return std::nullopt;
  }
  if (status == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  return value;
}

Stamp stamp_in(std::string_view text, std::size_t column, const std::string& place) {
  if (std::optional<Stamp> stamp = parse_stamp(text)) return *std::move(stamp);
  std::string shown(text.substr(0, 40));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  throw Error("{}: column {} is '{}', expected a stamp, a finite number", place, column + 1, shown);
}

// The last word of the name that begins with the word `first`.
std::size_t end_of_name(std::string_view row, const std::vector<Word>& words, std::size_t first) {
  if (words[first].quoted) return first;
  for (std::size_t i = first; i < words.size() && !words[i].quoted; ++i) {
    if (has_image_suffix(text_of(row, words[i]))) return i;
  }
  return first;
}

std::string name_in(std::string_view row, const Word& first, const Word& last) {
  return std::string(row.substr(first.begin, last.end - first.begin));
}

// Calls use(row, its words, "file:line") for each row with content.
template <class Use>
void for_each_row(const fs::path& path, const Use& use) {
  const std::string text = read_text(path, kMaxListBytes);
  std::string_view rest = text;
  std::size_t rows = 0;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view row = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::vector<Word> words = words_of(row);
    if (words.empty() || row[words.front().begin] == '#') continue;
    if (++rows > kMaxRows) throw Error("{}: more than {} rows", path.string(), kMaxRows);
    use(row, words, fmt::format("{}:{}", path.string(), line));
  }
  if (rows == 0) throw Error("{}: the list is empty", path.string());
}

// The images of a row, two at most.
std::vector<ListedImage> images_in(std::string_view row,
                                   const std::vector<Word>& words,
                                   const std::string& place) {
  std::vector<ListedImage> images;
  std::optional<Stamp> stamp;
  for (std::size_t i = 0; i < words.size() && images.size() < 2; ++i) {
    const std::string_view text = text_of(row, words[i]);
    if (!words[i].quoted && number_in(text)) {
      stamp = stamp_in(text, i, place);
      continue;
    }
    const std::size_t last = end_of_name(row, words, i);
    images.push_back(
        {std::exchange(stamp, std::nullopt), name_in(row, words[i], words[last]), place});
    i = last;
  }
  return images;
}

// The file below `folder` that a path of another machine means, by as many of its last parts as
// fit.
std::optional<fs::path> below(const fs::path& folder, const fs::path& elsewhere) {
  std::vector<fs::path> parts(elsewhere.begin(), elsewhere.end());
  for (std::size_t first = 1; first < parts.size(); ++first) {
    fs::path tail;
    for (std::size_t i = first; i < parts.size(); ++i) tail /= parts[i];
    if (path_exists(folder / tail)) return folder / tail;
  }
  return std::nullopt;
}

}  // namespace

bool has_image_suffix(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return false;
  const std::string suffix = ascii_lower(std::string(name.substr(dot + 1)));
  return suffix == "png" || suffix == "jpg" || suffix == "jpeg";
}

std::vector<ListedImage> read_image_list(const fs::path& path) {
  std::vector<ListedImage> images;
  for_each_row(
      path, [&](std::string_view row, const std::vector<Word>& words, const std::string& place) {
        Stamp stamp = stamp_in(text_of(row, words[0]), 0, place);
        if (words.size() < 2) throw Error("{}: 1 columns, expected 2: stamp file", place);
        std::size_t last = end_of_name(row, words, 1);
        const bool whole_row = !words[last].quoted && !has_image_suffix(text_of(row, words[last]));
        if (whole_row) last = words.size() - 1;
        images.push_back({std::move(stamp), name_in(row, words[1], words[last]), place});
      });
  return images;
}

std::vector<std::pair<ListedImage, ListedImage>> read_image_pairs(const fs::path& path) {
  std::vector<std::pair<ListedImage, ListedImage>> pairs;
  for_each_row(
      path, [&](std::string_view row, const std::vector<Word>& words, const std::string& place) {
        std::vector<ListedImage> images = images_in(row, words, place);
        if (images.size() < 2) {
          throw Error("{}: {} images, expected 2: stamp_rgb file_rgb stamp_depth file_depth",
                      place,
                      images.size());
        }
        pairs.emplace_back(std::move(images[0]), std::move(images[1]));
      });
  return pairs;
}

// A sequence may come from an untrusted source: its lists reach nothing but images outside.
fs::path listed_file(const fs::path& folder, const ListedImage& image) {
  std::string name = image.name;
  std::ranges::replace(name, '\\', '/');
  const bool drive = name.size() > 2 && name[1] == ':' && name[2] == '/';
  const fs::path listed(drive ? name.substr(2) : name);
  const bool upwards = std::ranges::find(listed, fs::path("..")) != listed.end();
  if (!listed.is_absolute() && !upwards) return folder / listed;
  if (listed.is_absolute() && !upwards) {
    if (const std::optional<fs::path> found = below(folder, listed)) return *found;
    if (has_image_suffix(name)) return listed;
  }
  throw Error("{}: '{}' leads out of the sequence, expected a file below its folder",
              image.place,
              image.name);
}

}  // namespace stillmap
