// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/ids.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The error of a sequence whose camera is not known.
class UnknownCamera : public Error {
 public:
  using Error::Error;
};

struct SequenceOptions {
  std::optional<CameraModel> camera;  ///< instead of the one that the sequence tells
};

struct FrameReading {
  FramePtr frame;       ///< not null
  std::string warning;  ///< see ColorFile; empty if nothing is wrong
};

/// A colour image and the depth image paired with it.
struct SequenceEntry {
  Stamp stamp;  ///< of the colour image, with the text of rgb.txt
  double depth_stamp_s = 0.0;
  std::filesystem::path color_file;
  std::filesystem::path depth_file;
};

/// An RGB-D sequence on disk in the layout of the TUM RGB-D benchmark.
///
/// Pairs come from associations.txt where there is one, else from the stamps in rgb.txt and
/// depth.txt: less than 0.02 s apart, the closest first, each image once.
class TumSequence {
 public:
  /// Reads the lists, no image. The camera is that of the options, else the folder's camera.yaml,
  /// else the one that a word of the folder's name tells (freiburg1, fr1, freiburg2, fr2,
  /// freiburg3, fr3, bonn), else that in truth/objects.json. Throws Error, with file and line, for
  /// a missing folder or list, an empty list, stamps that do not increase, a file outside the
  /// folder, or no pair at all; UnknownCamera when the camera is not known.
  [[nodiscard]] static TumSequence open(const std::filesystem::path& folder,
                                        const SequenceOptions& options = {});

  /// The folder's name.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const CameraModel& camera() const { return camera_; }

  /// The number of pairs, at least one; ids of frames count from 0.
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] const SequenceEntry& entry(FrameId id) const;
  [[nodiscard]] const std::vector<SequenceEntry>& entries() const { return entries_; }

  /// Decodes the images of a pair. May run in any number of threads. Throws Error, naming the file,
  /// when an image is missing, broken, of the wrong kind or not of the camera's size.
  [[nodiscard]] FramePtr read(FrameId id) const;
  /// The same, with what is wrong with the files beside the pixels.
  [[nodiscard]] FrameReading read_with_warning(FrameId id) const;

  /// groundtruth.txt, where the folder has it.
  [[nodiscard]] std::optional<std::filesystem::path> groundtruth_file() const;

 private:
  TumSequence() = default;

  std::filesystem::path folder_;
  std::string name_;
  CameraModel camera_;
  std::vector<SequenceEntry> entries_;
};

}  // namespace stillmap
