// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/rgbd_frame.hpp"

namespace stillmap {

struct LocalCloudConfig {
  double max_depth_m = 6.0;
  double voxel_size_m = 0.01;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_depth_m",
          self.max_depth_m,
          FieldInfo{"depth beyond this does not go into the map", "m", 0.1, 1000});
    visit("voxel_size_m",
          self.voxel_size_m,
          FieldInfo{
              "edge of the voxels that the map is thinned to, one point each", "m", 0.001, 1.0});
  }
};

/// The surface that a key frame sees, as points in its own camera's coordinates (metres).
///
/// They stay in these coordinates for good: a later correction of the key frame's pose, by bundle
/// adjustment or a closed loop, then costs nothing, as the pose is applied when the map is
/// assembled (global_cloud; Fan 2020, Eq. (1)).
///
/// Pixels without depth (0, negative, not finite), with depth over `max_depth_m` or where
/// `dynamic`, which may be empty, is not 0 are left out. The rest is thinned to one mean point a
/// voxel, which bounds what a key frame keeps in memory by the surface it sees. `rays` are the
/// camera's pixel_rays(), of the frame's size. A point's label is that of most of its pixels in
/// `labels`; without such an image the cloud has no labels. Takes time linear in the number of
/// pixels.
[[nodiscard]] PointCloud local_cloud(const RgbdFrame& frame,
                                     const cv::Mat2f& rays,
                                     const LocalCloudConfig& config,
                                     const cv::Mat1b& dynamic = {},
                                     const cv::Mat1b& labels = {});

}  // namespace stillmap
