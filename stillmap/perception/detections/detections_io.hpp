// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/detections/detections_line.hpp"

namespace stillmap {

/// Writes a folder of detections: `detections.jsonl` with a line a frame and `masks/<stamp>.png`.
/// The list comes last, so that a folder that has one is complete.
class DetectionsWriter {
 public:
  /// Makes the folder where it is not there, and takes away the list of an earlier time. `image` is
  /// the size of the sequence's images. Throws Error when the folder cannot be made.
  DetectionsWriter(std::filesystem::path folder, cv::Size image);

  /// Writes the mask of a frame and keeps its line. Frames come in the order of their stamps.
  /// Throws Error when the mask cannot be written, and for whatever DetectionsFolder would refuse.
  void add(const FrameDetections& frame);

  /// Writes the list. Nothing is added afterwards.
  void finish();

 private:
  std::filesystem::path folder_;
  cv::Size image_;
  std::string list_;
  std::size_t frames_ = 0;
  double last_stamp_s_ = -1.0;
};

/// A folder of detections, made by DetectionsWriter or by anybody. Safe to use from several
/// threads.
class DetectionsFolder {
 public:
  /// Reads the list, no mask. `image` is the size of the sequence's images. Throws Error, with file
  /// and line, for a missing list, one of more than 256 MiB or a million lines, an empty one,
  /// stamps that do not increase, and whatever parse_detections_line() refuses.
  [[nodiscard]] static DetectionsFolder open(const std::filesystem::path& folder, cv::Size image);

  /// The number of frames, at least one.
  [[nodiscard]] std::size_t size() const { return lines_.size(); }

  /// Whether the list has a frame of this stamp; stamps are equal as numbers: a
  /// zero more at the end makes no other stamp.
  [[nodiscard]] bool contains(const Stamp& stamp) const;

  /// What was found in a frame; its stamp is the list's. A frame without a file in masks/ is one
  /// whose objects have no pixels. Throws Error for a stamp that is not in the list, and for a mask
  /// that is broken, of another size than the images or has an id that its line has not.
  [[nodiscard]] FrameDetections at(const Stamp& stamp) const;

 private:
  struct Entry {
    DetectionsLine line;
    std::size_t number = 0;  ///< of the line in the file
  };

  DetectionsFolder() = default;
  void add_line(std::string_view text, std::size_t number);
  [[nodiscard]] const Entry* find(const Stamp& stamp) const;
  [[nodiscard]] ObjectMask read_object_mask(const Entry& entry) const;

  std::filesystem::path folder_;
  cv::Size image_;
  std::vector<Entry> lines_;  // by stamp
};

}  // namespace stillmap
