// SPDX-License-Identifier: Apache-2.0
// Any rgb.txt, depth.txt and associations.txt give frames in order, of files without `..` in
// their names, or are refused.
#include <algorithm>
#include <limits>
#include <optional>

#include "fuzz/harness.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/sensor/tum_lists.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::vector<std::string_view> parts = parts_of(bytes, 3);
  (void)folder.put("rgb.txt", parts[0]);
  (void)folder.put("depth.txt", parts[1]);
  const std::filesystem::path associations = folder.put("associations.txt", parts[2]);
  if (parts[2].empty()) std::filesystem::remove(associations);
  read_or_refuse([&] {
    const std::vector<SequenceEntry> entries = open_tum_lists(folder.path(), {}).entries;
    require(!entries.empty(), "there are frames");
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      require(i == 0 || entries[i - 1].stamp.seconds < entries[i].stamp.seconds, "in order");
      // In the unit of the list, which need not be seconds.
      const std::optional<Stamp> stamp = parse_stamp(entries[i].stamp.text);
      require(stamp && last < stamp->seconds, "a stamp");
      last = stamp->seconds;
      for (const auto& file : {entries[i].color_file, entries[i].depth_file}) {
        require(std::ranges::find(file, "..") == file.end(), "no way up");
      }
    }
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
