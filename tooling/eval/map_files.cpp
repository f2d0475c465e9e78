// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/map_files.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/io/ply.hpp"

namespace stillmap {

PointCloud read_map(const std::filesystem::path& file) {
  PointCloud cloud = read_ply(file);
  check_extent(cloud, file.string());
  return cloud;
}

MapTruth read_map_truth(const std::filesystem::path& static_file,
                        const std::optional<std::filesystem::path>& dynamic_file,
                        const std::optional<std::filesystem::path>& resting_file) {
  MapTruth truth{.static_surface = read_map(static_file), .dynamic = std::nullopt};
  if (truth.static_surface.empty()) {
    throw Error("{}: no points, expected the static surface that the sequence shows",
                static_file.string());
  }
  if (dynamic_file) truth.dynamic = read_map(*dynamic_file);
  if (resting_file) truth.resting = read_map(*resting_file);
  return truth;
}

}  // namespace stillmap
