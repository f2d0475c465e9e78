// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/open_sequence.hpp"

#include "stillmap/sensor/sequence_stream.hpp"

namespace stillmap {

std::unique_ptr<FrameStream> open_sequence(const std::filesystem::path& folder,
                                           const std::optional<CameraModel>& camera,
                                           const std::string& format) {
  return std::make_unique<SequenceStream>(
      Sequence::open(folder, {.camera = camera, .format = format}));
}

}  // namespace stillmap
