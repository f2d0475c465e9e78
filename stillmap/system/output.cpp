// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/output.hpp"

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"

namespace stillmap {

void save_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_file_atomically(file, format_trajectory(trajectory));
}

void save_map(const std::filesystem::path& file, const PointCloud& map) {
  write_file_atomically(file, encode_ply(map));
}

}  // namespace stillmap
