// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// The label of each pixel: class_label() of the static object there, or 0. Empty if there are no
/// labels.
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
          FieldInfo{"cells: number of square cells across the image", "", 1, 10000});
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

/// Edge in pixels of the square cells of local_cloud() in an image of that width.
[[nodiscard]] int cell_side(int width_px, const LocalCloudConfig& config);

/// The static surface of a frame as points in camera coordinates (metres).
///
/// The points keep these coordinates. A later correction of the view's pose, by bundle adjustment
/// or a loop closure, costs nothing, because poses are applied when the map is assembled
/// (global_cloud; Fan 2020, section III, Eq. (1)).
///
/// `depth` is the result of static_depth(), 0 where there is no surface. The image is divided into
/// square cells. A pixel of depth z joins the last point of its cell whose depth so far is within
/// join_per_m (z + join_offset_m)^2 of z, else it begins a new point; a point is the mean of its
/// pixels. The bound is a little more than the camera's noise. Far pixels differ by noise more than
/// by their distance, so that their mean is nearer to the surface. Averaging also bounds the memory
/// of a view.
///
/// `rays` are the camera's pixel_rays(). The label of a point is that of most of its pixels in
/// `labels`; without labels the cloud has none. All images have one size. Points are in the order
/// of their cells, row by row. Takes time linear in the number of pixels.
[[nodiscard]] PointCloud local_cloud(const cv::Mat1f& depth,
                                     const ColorImage& color,
                                     const cv::Mat2f& rays,
                                     const LocalCloudConfig& config,
                                     const LabelImage& labels = {});

}  // namespace stillmap
