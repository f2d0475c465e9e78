// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/merge_tree.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/session/session_io.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct Part {
  std::size_t rank = 0;  // of its earliest session
  MergedPart map;
};

struct Leaf {
  double first_stamp_s = 0;
  MergedPart map;
};

Leaf leaf_of(const fs::path& file) {
  const Session session = read_session(file, {.with_views = false});
  const double stamp_s = session.frames.empty() ? std::numeric_limits<double>::infinity()
                                                : session.frames.front().stamp.seconds;
  return {stamp_s, {file, {file.string()}, session.map.keyframes().size(), 0}};
}

bool bytes_come_first(const fs::path& a, const fs::path& b) {
  using Bytes = std::istreambuf_iterator<char>;
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  return std::lexicographical_compare(Bytes(first), Bytes(), Bytes(second), Bytes());
}

bool comes_first(const Leaf& a, const Leaf& b) {
  if (a.first_stamp_s != b.first_stamp_s) return a.first_stamp_s < b.first_stamp_s;
  return bytes_come_first(a.map.file, b.map.file);
}

std::vector<Part> ranked(const std::vector<fs::path>& files) {
  std::vector<Leaf> leaves;
  for (const fs::path& file : files) leaves.push_back(leaf_of(file));
  std::ranges::stable_sort(leaves, comes_first);
  std::vector<Part> parts;
  for (Leaf& leaf : leaves) parts.push_back({parts.size(), std::move(leaf.map)});
  return parts;
}

class Tree {
 public:
  explicit Tree(fs::path scratch) : scratch_(std::move(scratch)) {}

  std::vector<Part> merge(std::span<const Part> leaves) {
    if (leaves.size() == 1) return {leaves.front()};
    const std::size_t half = (leaves.size() + 1) / 2;
    std::vector<Part> parts = merge(leaves.first(half));
    for (Part& later : merge(leaves.subspan(half))) parts = taken_in(parts, std::move(later));
    return parts;
  }

 private:
  // Parts that have nothing in common may each have something in common with one more.
  std::vector<Part> taken_in(const std::vector<Part>& parts, Part more) {
    std::vector<Part> all;
    for (const Part& part : parts) {
      std::optional<Part> both = part.rank < more.rank ? joined(part, more) : joined(more, part);
      if (both) {
        more = std::move(*both);
      } else {
        all.push_back(part);
      }
    }
    all.push_back(std::move(more));
    std::ranges::sort(all, {}, &Part::rank);
    return all;
  }

  // Nothing if they have no place in common.
  std::optional<Part> joined(const Part& earlier, const Part& later) {
    const fs::path file = scratch_ / fmt::format("{}.stillmap", written_);
    Part both{earlier.rank, {file, earlier.map.sessions, 0, earlier.map.loops + later.map.loops}};
    {
      const Session first = read_session(earlier.map.file), second = read_session(later.map.file);
      const auto merged = merge_sessions(first, second, later.map.sessions.front());
      if (!merged) return std::nullopt;
      write_session(file, merged->session);
      both.map.keyframes = merged->session.map.keyframes().size();
      both.map.loops += merged->loops;
    }
    ++written_;
    const std::vector<std::string>& added = later.map.sessions;
    both.map.sessions.insert(both.map.sessions.end(), added.begin(), added.end());
    remove_merged(earlier.map);
    remove_merged(later.map);
    return both;
  }

  // The given files stay.
  static void remove_merged(const MergedPart& map) {
    if (map.sessions.size() > 1) fs::remove(map.file);
  }

  fs::path scratch_;
  std::size_t written_ = 0;
};

}  // namespace

std::vector<MergedPart> merge_as_tree(const std::vector<fs::path>& files, const fs::path& scratch) {
  std::vector<MergedPart> maps;
  for (Part& part : Tree(scratch).merge(ranked(files))) maps.push_back(std::move(part.map));
  std::ranges::stable_sort(maps, std::ranges::greater(), &MergedPart::keyframes);
  return maps;
}

}  // namespace stillmap
