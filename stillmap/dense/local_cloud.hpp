// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// A class label for each pixel: class_label() of the static object there, 0 where there is none.
/// Empty: no labels are known.
struct LabelImage {
  cv::Mat1b mat;
  LabelImage() = default;
  explicit LabelImage(cv::Mat1b labels) : mat(std::move(labels)) {}

  [[nodiscard]] bool empty() const { return mat.empty(); }
};

struct LocalCloudConfig {
  int cells_across = 160;
  double join_per_m = 0.003;
  double join_offset_m = 0.8;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cells_across",
          self.cells_across,
          FieldInfo{"number of square cells across the image; a view's points are means over cells",
                    "",
                    1,
                    10000});
    visit("join_per_m",
          self.join_per_m,
          FieldInfo{"depth within which pixels of a cell form one point: join_per_m (depth + "
                    "join_offset_m)^2",
                    "1/m",
                    0,
                    1});
    visit("join_offset_m",
          self.join_offset_m,
          FieldInfo{"offset in the formula of join_per_m", "m", 0, 100});
  }
};

/// The surface that a view sees, as points in its own camera's coordinates (metres).
///
/// They stay in these coordinates for good: a later correction of the view's pose, by bundle
/// adjustment or a closed loop, then costs nothing, as the pose is applied when the map is
/// assembled (global_cloud; Fan 2020, Eq. (1)).
///
/// `depth` is what static_depth() has left: 0 where there is no point. The image is divided into
/// square cells. A pixel of depth z joins the last point of its cell that is, so far, within
/// join_per_m (z + join_offset_m)^2 of z, else it begins another; a point is the mean of its
/// pixels. That is a little more than the camera's noise: far pixels differ more by noise than they
/// are apart, and their mean is nearer to the surface than they are. It also bounds what a key
/// frame keeps in memory.
///
/// `rays` are the camera's pixel_rays(). A point's label is that of most of its pixels in `labels`;
/// without such an image the cloud has no labels. All images are of one size. Points are in the
/// order of their cells, row by row. Takes time linear in the number of pixels.
[[nodiscard]] PointCloud local_cloud(const cv::Mat1f& depth,
                                     const ColorImage& color,
                                     const cv::Mat2f& rays,
                                     const LocalCloudConfig& config,
                                     const LabelImage& labels = {});

}  // namespace stillmap
