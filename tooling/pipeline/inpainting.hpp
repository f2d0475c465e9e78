// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Geometry>

#include "stillmap/core/images.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The number of key frames that Bescos et al. 2018 take the background from.
inline constexpr std::size_t kInpaintingKeyframes = 20;

/// A frame whose dynamic pixels show what is behind them, where a key frame has seen it.
struct InpaintedFrame {
  ColorImage color;     ///< black where nothing is known
  DepthImage depth;     ///< metres; 0 where nothing is known
  Mask filled;          ///< the pixels taken from key frames
  double filled_share;  ///< of the dynamic pixels; 1 without any
};

/// Paints the background over dynamic pixels (Bescos et al., "DynaSLAM: Tracking, Mapping, and
/// Inpainting in Dynamic Scenes", IEEE RA-L 2018, section III-E): colour and depth of the last key
/// frames are projected into the frame; of several points at a pixel the nearest counts. What no
/// key frame has seen stays empty.
class Inpainter {
 public:
  explicit Inpainter(const CameraModel& camera, std::size_t keyframes = kInpaintingKeyframes);

  /// Keeps a key frame; the oldest one leaves. Its `dynamic` pixels are no background.
  void add_keyframe(const RgbdFrame& frame,
                    const Mask& dynamic,
                    const Eigen::Isometry3d& T_world_camera);

  /// The frame without what is at its `dynamic` pixels. Images have the camera's size; `dynamic`
  /// may be empty.
  [[nodiscard]] InpaintedFrame inpaint(const RgbdFrame& frame,
                                       const Mask& dynamic,
                                       const Eigen::Isometry3d& T_world_camera) const;

 private:
  struct Keyframe {
    cv::Mat3b color;
    cv::Mat1f depth;
    Mask dynamic;
    Eigen::Isometry3d T_world_camera;
  };
  void paint(const Keyframe& keyframe,
             const Mask& dynamic,
             const Eigen::Isometry3d& T_world_camera,
             InpaintedFrame& onto) const;

  CameraModel camera_;
  cv::Mat2f rays_;
  std::size_t most_;
  std::deque<Keyframe> keyframes_;
};

}  // namespace stillmap
