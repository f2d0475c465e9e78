// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// Reads people from a folder of plain masks, made by any program: one 8-bit PNG per image, 0 for
/// the background and one other value (1, 255) for people, named as the image or as its stamp.
///
/// Each connected region of at least 50 pixels is one person. A single object of all regions would
/// have a box across all people and the depths of all of them, and every object between them would
/// count as touched by a person.
class MaskFolder : public Segmenter {
 public:
  /// `image` is the size of the images, `names` as in SegmenterOptions. Throws Error for a folder
  /// that is missing or has no PNG.
  MaskFolder(std::filesystem::path folder,
             cv::Size image,
             std::map<std::string, std::string> names);

  /// Throws Error for an image without a mask, and for a mask that is damaged, has another size
  /// than the images, or more than two values.
  [[nodiscard]] FrameDetections segment(const ColorImage& color, const Stamp& stamp) const override;

 private:
  [[nodiscard]] std::filesystem::path file_of(const Stamp& stamp) const;

  std::filesystem::path folder_;
  cv::Size image_;
  std::map<std::string, std::string> names_;
};

}  // namespace stillmap
