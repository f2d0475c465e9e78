// SPDX-License-Identifier: Apache-2.0
#include "stillmap/core/rgbd_frame.hpp"

#include <utility>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {

GrayImage to_gray(const ColorImage& color) {
  GrayImage gray;
  cv::cvtColor(color.mat, gray.mat, cv::COLOR_RGB2GRAY);
  return gray;
}

RgbdFrame make_frame(double stamp_s, ColorImage color, DepthImage depth) {
  if (color.mat.empty() || color.mat.size() != depth.mat.size()) {
    throw Error("a frame of {} x {} px colour and {} x {} px depth: expected images of one size",
                color.mat.cols,
                color.mat.rows,
                depth.mat.cols,
                depth.mat.rows);
  }
  RgbdFrame frame;
  frame.stamp = {stamp_s, fmt::format("{:.6f}", stamp_s)};
  frame.depth_stamp_s = stamp_s;
  frame.gray = to_gray(color);
  frame.color = std::move(color);
  frame.depth = std::move(depth);
  return frame;
}

}  // namespace stillmap
