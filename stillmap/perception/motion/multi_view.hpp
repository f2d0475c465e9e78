// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/motion/depth_jump.hpp"

namespace stillmap {

struct MultiViewConfig {
  int views = 5;
  double max_parallax_deg = 30;
  double nearer_m = 0.4;
  double grow_m = 0.2;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("views",
          self.views,
          FieldInfo{"dynaslam: number of earlier frames, the nearest in pose, that a frame is "
                    "compared with (5 in Bescos 2018)",
                    "",
                    1,
                    100});
    visit("max_parallax_deg",
          self.max_parallax_deg,
          FieldInfo{"dynaslam: angle between the two views of a point above which it is not judged",
                    "deg",
                    0,
                    180});
    visit("nearer_m",
          self.nearer_m,
          FieldInfo{"dynaslam: how much nearer than an earlier point the depth at its pixel is "
                    "where something moved in front of it",
                    "m",
                    0,
                    100});
    visit("grow_m",
          self.grow_m,
          FieldInfo{"dynaslam: difference of depth within which the pixels around such a point "
                    "belong to the same object",
                    "m",
                    0,
                    10});
  }
};

/// The points of an earlier frame's features that have depth.
struct PointView {
  std::span<const Eigen::Vector3d> points;  ///< in its camera's coordinates
  Eigen::Isometry3d T_current_view;         ///< where that camera was, in the current one
};

/// The pixels of objects that hide points of earlier frames, marked kCameNearer (Bescos et al.,
/// "DynaSLAM: Tracking, Mapping, and Inpainting in Dynamic Scenes", IEEE RA-L 2018, section III-C).
///
/// Each point is projected into the current frame. It is not judged where the rays of both views
/// differ by more than `max_parallax_deg`, because it may be hidden by something static, nor where
/// the depth around its pixel varies by more than `grow_m`, as at the border of an object. If the
/// depth at the pixel is more than `nearer_m` less than that of the point, the pixel is dynamic,
/// and with it the pixels connected to it whose depth is within `grow_m` of its own.
[[nodiscard]] JumpImage hiding_objects(const DepthImage& current,
                                       std::span<const PointView> views,
                                       const CameraModel& camera,
                                       const MultiViewConfig& config);

}  // namespace stillmap
