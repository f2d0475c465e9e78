// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {

/// A colour image and the depth image paired with it.
struct SequenceEntry {
  Stamp stamp;                       ///< of the colour image, with the text of its list
  double depth_stamp_s = 0.0;        ///< of the depth image
  std::filesystem::path color_file;  ///< empty where the recording is one file
  std::filesystem::path depth_file;  ///< empty where the recording is one file
};

/// The images of an entry.
struct ImagePair {
  ColorFile color;
  DepthImage depth;
};

/// Decodes the images of a sequence, each when it is asked for. Any thread may call, several at a
/// time. Throws DamagedImage for an image that is missing or broken, and Error for one of the wrong
/// kind; both name it.
class ImageReader {
 public:
  ImageReader() = default;
  ImageReader(const ImageReader&) = delete;
  ImageReader& operator=(const ImageReader&) = delete;
  virtual ~ImageReader() = default;

  /// The colour image of the entry `index`, and what is wrong with it beside the pixels.
  [[nodiscard]] virtual ColorFile color(std::size_t index) const = 0;
  /// The depth image of the entry `index`; `depth_factor` is that of the camera, for formats that
  /// do not tell the unit of their depth.
  [[nodiscard]] virtual DepthImage depth(std::size_t index, double depth_factor) const = 0;
  /// Both, in less time where one is made with the other.
  [[nodiscard]] virtual ImagePair pair(std::size_t index, double depth_factor) const {
    return {color(index), depth(index, depth_factor)};
  }
};

/// The true poses of a recording, and what was wrong with them.
struct GroundTruth {
  Trajectory poses;  ///< none where they cannot be used
  std::vector<std::string> warnings;
};

/// How exact the depth of a recording is, where it is not that of a depth camera.
struct DepthNoise {
  double inverse_depth_sigma = 0;  ///< standard deviation of the inverse depth, 1/m
  double max_depth_m = 0;          ///< greatest depth
};

/// What is said of how a recording was read; a line each.
struct Remarks {
  std::vector<std::string> notes;     ///< how it was understood
  std::vector<std::string> warnings;  ///< what had to be left out

  /// Appends others.
  void add(const Remarks& more) {
    notes.insert(notes.end(), more.notes.begin(), more.notes.end());
    warnings.insert(warnings.end(), more.warnings.begin(), more.warnings.end());
  }
};

/// What the reader of a format finds in a recording before it decodes an image.
struct SequenceContent {
  std::vector<SequenceEntry> entries;  ///< at least one; stamps strictly increase
  std::shared_ptr<const ImageReader> images;
  std::optional<CameraModel> camera;         ///< as the recording tells it
  std::string no_camera;                     ///< why it does not, where there is more to say
  std::optional<DepthNoise> depth_noise;     ///< of depth made from stereo pairs with `camera`
  std::function<GroundTruth()> groundtruth;  ///< reads it; empty where the recording has none
  Remarks remarks;
};

}  // namespace stillmap
