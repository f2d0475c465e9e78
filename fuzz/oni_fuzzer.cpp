// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a recording of OpenNI, or refused; its first images are decoded, or
// refused.
#include <algorithm>

#include "fuzz/harness.hpp"
#include "tooling/recordings/oni.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::filesystem::path path = folder.put("input.oni", bytes);
  read_or_refuse([&] {
    const SequenceContent content = open_oni(path, {});
    require(!content.entries.empty(), "a recording has frames");
    for (std::size_t i = 0; i < std::min<std::size_t>(2, content.entries.size()); ++i) {
      read_or_refuse([&] { require(!content.images->color(i).color.mat.empty(), "pixels"); });
      read_or_refuse([&] { require(!content.images->depth(i, 1000).mat.empty(), "pixels"); });
    }
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
