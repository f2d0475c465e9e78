// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a trajectory or refused; what is read is written and read again.
#include "fuzz/harness.hpp"
#include "stillmap/io/trajectory_io.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::filesystem::path file = folder.put("trajectory.txt", bytes);
  read_or_refuse([&] {
    const Trajectory first = read_trajectory(file);
    const Trajectory again = read_trajectory(folder.put("again.txt", format_trajectory(first)));
    require(first.size() == again.size() && !first.empty(), "the same number of poses");
    for (std::size_t i = 0; i < first.size(); ++i) {
      require(i == 0 || first[i - 1].stamp.seconds < first[i].stamp.seconds, "in order");
      require(first[i].stamp.text == again[i].stamp.text, "the same stamp");
      require(again[i].T_world_camera.isApprox(first[i].T_world_camera, 1e-5), "the same pose");
    }
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
