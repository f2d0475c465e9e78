// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/ids.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/frame_reader.hpp"
#include "stillmap/sensor/sequence_content.hpp"
#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// The error of a sequence whose camera is not known.
class UnknownCamera : public Error {
 public:
  using Error::Error;
};

struct SequenceOptions {
  std::optional<CameraModel> camera = {};  ///< instead of the one that the sequence tells
  std::string format = {};  ///< name of its format; empty: the one that it looks like
  ReadingOptions reading = {};
  std::span<const SequenceFormat> formats = folder_formats();  ///< to choose from
};

/// A recording of an RGB-D camera in one of the formats of docs/inputs.md: pairs of a colour and a
/// depth image in the order of their stamps.
class Sequence {
 public:
  /// Reads what the recording says of itself, and decodes no image. The camera is that of the
  /// options, else the folder's camera.yaml, else the one that the format tells, else the one that
  /// a word of the folder's name tells (freiburg1, fr1, freiburg2, fr2, freiburg3, fr3, bonn), else
  /// that in truth/objects.json; of stereo pairs, the one of their calibration alone. Throws Error
  /// as choose_format() and the format's reader do; UnknownCamera when the camera is not known.
  [[nodiscard]] static Sequence open(const std::filesystem::path& path,
                                     const SequenceOptions& options = {});

  /// The name of the folder or file.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The name of its format.
  [[nodiscard]] std::string_view format() const { return format_; }
  [[nodiscard]] const CameraModel& camera() const { return reader_.camera(); }
  /// The noise of its depth where that is made from stereo pairs; nothing for a depth camera.
  [[nodiscard]] const std::optional<DepthNoise>& depth_noise() const {
    return content_.depth_noise;
  }
  /// Frames are those of another camera from now on.
  void use_camera(const CameraModel& camera) { reader_ = FrameReader(camera); }

  /// The number of pairs, at least one; ids of frames count from 0.
  [[nodiscard]] std::size_t size() const { return content_.entries.size(); }
  [[nodiscard]] const SequenceEntry& entry(FrameId id) const;
  [[nodiscard]] const std::vector<SequenceEntry>& entries() const { return content_.entries; }

  /// Decodes the images of a pair. May run in any number of threads. Throws DamagedImage, naming
  /// the file, when an image is missing or broken, and Error when it is of the wrong kind or not of
  /// the camera's size.
  [[nodiscard]] FramePtr read(FrameId id) const;
  /// The same, with what is wrong with the files beside the pixels.
  [[nodiscard]] FrameReading read_with_warning(FrameId id) const;

  /// The depth image of a pair in the units that are stored, as its own camera sees it. Throws as
  /// read().
  [[nodiscard]] DepthImage stored_depth(FrameId id) const;

  /// The recording's own ground truth; nothing where it has none.
  [[nodiscard]] std::optional<GroundTruth> groundtruth() const;

  /// How the recording was read.
  [[nodiscard]] const Remarks& remarks() const { return content_.remarks; }

 private:
  Sequence() = default;

  std::filesystem::path path_;
  std::string name_;
  std::string_view format_;
  FrameReader reader_;
  SequenceContent content_;
};

}  // namespace stillmap
