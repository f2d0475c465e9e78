// SPDX-License-Identifier: Apache-2.0
// Camera trajectory and map of a recorded sequence:  01_sequence SEQUENCE OUT
#include <cstdio>
#include <filesystem>
#include <variant>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/open_sequence.hpp"
#include "stillmap/system/output.hpp"
#include "stillmap/system/system.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: 01_sequence SEQUENCE OUT\n", stderr);
    return 2;
  }
  try {
    const std::unique_ptr<stillmap::FrameStream> sequence = stillmap::open_sequence(argv[1]);
    stillmap::System slam({}, sequence->camera(), {.threads = 2});
    while (const std::optional<stillmap::StreamedFrame> next = sequence->next()) {
      if (const auto* frame = std::get_if<stillmap::FramePtr>(&*next)) {
        slam.process(*frame);
      } else {
        std::fprintf(stderr, "%s\n", std::get<stillmap::DamagedFrame>(*next).damage.c_str());
      }
    }
    const stillmap::RunResult run = slam.finish();
    const std::filesystem::path out = argv[2];
    std::filesystem::create_directories(out);
    stillmap::save_trajectory(out / "trajectory.txt", run.trajectory);
    stillmap::save_map(out / "map.ply", run.map);
    std::printf("%zu poses, %zu points\n", run.trajectory.size(), run.map.size());
    return run.trajectory.empty() ? 1 : 0;
  } catch (const stillmap::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
