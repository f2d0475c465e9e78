// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

struct OrbConfig {
  int features = 1000;
  int levels = 8;
  double scale_factor = 1.2;
  int corner_threshold = 20;
  int weak_corner_threshold = 7;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("features",
          self.features,
          common_setting(FieldInfo{"number of features to extract from a frame", "", 50, 20000}));
    visit("levels", self.levels, FieldInfo{"number of levels of the image pyramid", "", 1, 16});
    visit("scale_factor",
          self.scale_factor,
          FieldInfo{"ratio of the sizes of two consecutive pyramid levels", "", 1.05, 2});
    visit("corner_threshold",
          self.corner_threshold,
          FieldInfo{"difference of brightness that makes a corner (FAST)", "grey levels", 2, 200});
    visit("weak_corner_threshold",
          self.weak_corner_threshold,
          FieldInfo{"the same, for image cells in which tracking.corner_threshold finds no corner",
                    "grey levels",
                    1,
                    200});
  }
};

/// The part of feature extraction that does not depend on excluded pixels: the image pyramid and
/// all corners.
struct ImageCorners {
  struct Level {
    cv::Mat1b image;
    cv::Mat1b blurred;
    std::vector<cv::KeyPoint> corners;
  };
  std::vector<Level> levels;  ///< the finest first
};

/// Oriented FAST corners with rotated BRIEF descriptors (Rublee et al., "ORB", ICCV 2011) over an
/// image pyramid, spread evenly over the image on each level.
///
/// Keeps no state of images. Safe to use from several threads.
class OrbExtractor {
 public:
  OrbExtractor(const OrbConfig& config, const CameraModel& camera);

  /// The pyramid and corners of an image of the camera's size: the part of the work that needs no
  /// excluded pixels. The finest level shares the pixels of `gray`.
  [[nodiscard]] ImageCorners corners(const GrayImage& gray) const;

  /// Features at the best corners, with ideal and raw pixels and the depth of `depth`, of the
  /// camera's size, at the raw pixel. None at a pixel of `excluded`; the rest of the image then
  /// gets the whole number of features.
  [[nodiscard]] Features extract(const ImageCorners& corners,
                                 const DepthImage& depth,
                                 const Mask& excluded = {}) const;

  /// Both steps in one call.
  [[nodiscard]] Features extract(const GrayImage& gray,
                                 const DepthImage& depth,
                                 const Mask& excluded = {}) const {
    return extract(corners(gray), depth, excluded);
  }

  /// The pixel size of each level, in pixels of the full image.
  [[nodiscard]] const std::vector<float>& level_scales() const { return scales_; }

 private:
  struct Level {
    cv::Size size;
    int feature_count = 0;
  };

  [[nodiscard]] std::vector<cv::KeyPoint> detect(const cv::Mat1b& image) const;
  void append(std::size_t number,
              const ImageCorners::Level& level,
              const std::vector<cv::KeyPoint>& corners,
              Features& features) const;
  void place_in_space(const DepthImage& depth, Features& features) const;

  OrbConfig config_;
  CameraModel camera_;
  std::vector<float> scales_;
  std::vector<Level> levels_;
};

/// The scales of a pyramid: 1, f, f^2, ...
[[nodiscard]] std::vector<float> pyramid_scales(const OrbConfig& config);

}  // namespace stillmap
