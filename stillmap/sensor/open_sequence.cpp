// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/open_sequence.hpp"

#include "stillmap/sensor/tum_folder.hpp"

namespace stillmap {

std::unique_ptr<FrameStream> open_sequence(const std::filesystem::path& folder,
                                           const std::optional<CameraModel>& camera) {
  return std::make_unique<TumFolder>(TumSequence::open(folder, {.camera = camera}));
}

}  // namespace stillmap
