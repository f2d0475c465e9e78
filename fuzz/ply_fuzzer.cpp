// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a PLY or refused; what is read is written in both formats and read again.
#include "fuzz/harness.hpp"
#include "stillmap/io/ply.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::filesystem::path file = folder.put("input.ply", bytes);
  read_or_refuse([&] {
    const PointCloud cloud = read_ply(file);
    require(cloud.size() <= bytes.size(), "each point has bytes");
    for (const PlyFormat format : {PlyFormat::kBinary, PlyFormat::kAscii}) {
      const PointCloud again = read_ply(folder.put("again.ply", encode_ply(cloud, format)));
      require(again.positions == cloud.positions && again.colors == cloud.colors,
              "the same points");
    }
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
