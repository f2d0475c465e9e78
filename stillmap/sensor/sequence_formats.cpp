// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/sequence_formats.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/icl_nuim.hpp"
#include "stillmap/sensor/image_folders.hpp"
#include "stillmap/sensor/scannet.hpp"
#include "stillmap/sensor/seven_scenes.hpp"
#include "stillmap/sensor/tum_lists.hpp"

namespace stillmap {

std::span<const SequenceFormat> folder_formats() {
  static constexpr std::array<SequenceFormat, 5> kFormats = {
      {{"icl", "associations.txt and *.gt.freiburg", is_icl_nuim, open_icl_nuim},
       {"tum", "rgb.txt and depth.txt, or associations.txt", is_tum_lists, open_tum_lists},
       {"7scenes", "frame-*.color.png", is_seven_scenes, open_seven_scenes},
       {"scannet", "color/, depth/ and pose/", is_scannet, open_scannet},
       {"images", "color/ and depth/ of numbered images", is_image_folders, open_image_folders}}};
  return kFormats;
}

const SequenceFormat& choose_format(const std::filesystem::path& path,
                                    const std::string& name,
                                    std::span<const SequenceFormat> formats) {
  if (!path_exists(path)) throw Error("{}: no such file or folder", path.string());
  std::vector<std::string> names, looks;
  for (const SequenceFormat& format : formats) {
    if (name.empty() ? format.recognized(path) : format.name == name) return format;
    names.emplace_back(format.name);
    looks.push_back(fmt::format("{} ({})", format.looks, format.name));
  }
  if (!name.empty()) throw Error("{}: unknown format: {}", name, name_hint(name, names));
  throw Error("{}: no recording that is known; looked for {}; --format chooses one",
              path.string(),
              joined(looks, "; "));
}

}  // namespace stillmap
