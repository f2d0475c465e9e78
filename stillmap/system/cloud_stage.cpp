// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/cloud_stage.hpp"

namespace stillmap {

CloudConfig CloudConfig::decided(std::string_view dynamics_mode) const {
  CloudConfig config = *this;
  const bool paper = dynamics_mode == "paper", full = dynamics_mode == "full";
  if (depth.edges == "by_mode") config.depth.edges = paper ? "fixed" : full ? "growing" : "off";
  if (depth.islands == "by_mode") config.depth.islands = paper || full ? "on" : "off";
  return config;
}

KeyframeView keyframe_view(const RgbdFrame& frame,
                           const cv::Mat2f& rays,
                           const CloudConfig& config,
                           const cv::Mat1b& dynamic,
                           const cv::Mat1b& labels) {
  const cv::Mat1f depth = static_depth(frame.depth.mat, dynamic, config.depth);
  return {local_cloud(depth, frame.color, rays, config.local, labels)};
}

}  // namespace stillmap
