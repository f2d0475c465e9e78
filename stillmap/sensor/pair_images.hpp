// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// An image file and its time.
struct StampedImage {
  Stamp stamp;
  std::filesystem::path file;
};

/// Images of one kind in the order of their stamps, which strictly increase.
struct ImageList {
  std::string name;  ///< of the list or folder, for messages
  std::vector<StampedImage> images;
  Remarks remarks = {};  ///< of its stamps
};

/// Which images belong together.
struct PairedImages {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< indices into colour and depth
  Remarks remarks;  ///< colour images without depth, and a constant offset between the streams
};

/// Pairs images by their stamps, as associate() does. `place` is the recording, for messages.
/// Throws Error where no two belong together.
[[nodiscard]] PairedImages pair_by_stamp(const ImageList& color,
                                         const ImageList& depth,
                                         const std::string& place);

/// The entries of pairs of image files.
[[nodiscard]] std::vector<SequenceEntry> entries_of(const PairedImages& paired,
                                                    const ImageList& color,
                                                    const ImageList& depth);

}  // namespace stillmap
