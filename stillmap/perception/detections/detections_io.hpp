// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/io/folder_replacement.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/detections/detections_line.hpp"

namespace stillmap {

/// Writes a folder of detections: `detections.jsonl` with a line per frame, and
/// `masks/<stamp>.png`. They replace earlier ones all at once, at the end (FolderReplacement).
class DetectionsWriter {
 public:
  /// Creates the folder if necessary. `image` is the size of the sequence's images. Throws Error
  /// when the folder cannot be created.
  DetectionsWriter(const std::filesystem::path& folder, cv::Size image);
  /// The same in a folder of that name in `result`, which outlives the object and takes its place
  /// later.
  DetectionsWriter(const FolderReplacement& result,
                   const std::filesystem::path& name,
                   cv::Size image);

  /// Writes the mask of a frame and keeps its line. Frames must be in the order of their stamps.
  /// Throws Error when the mask cannot be written, and for detections that DetectionsFolder would
  /// refuse.
  void add(const FrameDetections& frame);

  /// Writes the list; all takes its place. No frame can be added afterwards.
  void finish();

 private:
  std::unique_ptr<FolderReplacement> own_;
  const FolderReplacement& result_;
  std::filesystem::path folder_;  // for messages
  std::filesystem::path name_;    // of the folder in the result
  cv::Size image_;
  std::string list_;
  std::size_t frames_ = 0;
  double last_stamp_s_ = -std::numeric_limits<double>::infinity();
};

/// A folder of detections, written by DetectionsWriter or any other program. Safe to use from
/// several threads.
class DetectionsFolder {
 public:
  /// Reads the list but no masks. `image` is the size of the sequence's images. Throws Error, with
  /// file and line, for a list that is missing, empty or larger than 256 MiB or a million lines,
  /// for stamps that do not increase, for lines that parse_detections_line() refuses, and where all
  /// boxes are in shares of the image instead of pixels.
  [[nodiscard]] static DetectionsFolder open(const std::filesystem::path& folder, cv::Size image);

  /// The number of frames, at least one.
  [[nodiscard]] std::size_t size() const { return lines_.size(); }

  /// Whether the list has a frame with this stamp. Stamps are compared as numbers: trailing zeros
  /// make no difference.
  [[nodiscard]] bool contains(const Stamp& stamp) const;

  /// The detections of a frame, with the stamp of the list. The objects of a frame without a file
  /// in masks/ have no masks. Throws Error for a stamp that is not in the list, and for a mask that
  /// is damaged, has another size than the images, has an id that the frame's line lacks, or shows
  /// that the boxes are [x, y, width, height].
  [[nodiscard]] FrameDetections at(const Stamp& stamp) const;

 private:
  struct Entry {
    DetectionsLine line;
    std::size_t number = 0;  ///< line number in the file
  };

  DetectionsFolder() = default;
  void add_line(std::string_view text, std::size_t number);
  void check_pixels() const;
  [[nodiscard]] const Entry* find(const Stamp& stamp) const;
  [[nodiscard]] ObjectMask read_object_mask(const Entry& entry) const;

  std::filesystem::path folder_;
  cv::Size image_;
  std::vector<Entry> lines_;  // by stamp
};

}  // namespace stillmap
