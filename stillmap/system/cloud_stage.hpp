// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <opencv2/core/mat.hpp>

#include "stillmap/cloud/local_cloud.hpp"
#include "stillmap/cloud/static_depth.hpp"
#include "stillmap/core/fields.hpp"
#include "stillmap/core/rgbd_frame.hpp"

namespace stillmap {

/// How the map's points are made of what the key frames see.
struct CloudConfig {
  double voxel_size_m = 0.01;
  StaticDepthConfig depth;
  LocalCloudConfig local;

  /// With every "by_mode" decided for a `dynamics.mode`.
  ///
  /// `paper` gets Fan 2020 to the letter: edges by its fixed threshold, and islands. `full` gets
  /// both too, but a threshold that grows with depth as the camera's noise does; the fixed one
  /// costs the farther walls. `off` and `mask` get neither: they are there to be compared with.
  [[nodiscard]] CloudConfig decided(std::string_view dynamics_mode) const;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("voxel_size_m",
          self.voxel_size_m,
          FieldInfo{
              "edge of the voxels that the map is thinned to, one point each", "m", 0.001, 1.0});
    StaticDepthConfig::fields(self.depth, visit);
    LocalCloudConfig::fields(self.local, visit);
  }
};

/// What a key frame keeps for the map.
struct KeyframeView {
  PointCloud cloud;
};

/// The static surface in a frame. `dynamic` and `labels` may be empty; `config` is decided.
[[nodiscard]] KeyframeView keyframe_view(const RgbdFrame& frame,
                                         const cv::Mat2f& rays,
                                         const CloudConfig& config,
                                         const cv::Mat1b& dynamic,
                                         const cv::Mat1b& labels);

}  // namespace stillmap
