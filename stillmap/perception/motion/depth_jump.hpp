// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The value of a pixel of a JumpImage.
enum DepthJump : std::uint8_t {
  kNoJump = 0,       ///< unchanged, or nothing is known
  kCameNearer = 1,   ///< surface appeared in front of the earlier surface
  kWentFarther = 2,  ///< the earlier surface is gone
};

/// The depth jumps of an image: a DepthJump for each pixel.
struct JumpImage {
  cv::Mat1b mat;
  JumpImage() = default;
  explicit JumpImage(cv::Mat1b jumps) : mat(std::move(jumps)) {}
};

struct DepthJumpConfig {
  bool enabled = true;
  double jump_m = 0.1;
  double jump_per_m = 0.01;
  bool revealed = false;
  double paper_jump_m = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"whether depth jumps are removed"});
    visit("jump_m",
          self.jump_m,
          FieldInfo{"full: difference from the warped earlier depth that makes a jump, in addition "
                    "to noise",
                    "m",
                    0,
                    100});
    visit("jump_per_m",
          self.jump_per_m,
          FieldInfo{"full: growth of jump_m with depth squared", "1/m", 0, 10});
    visit("revealed",
          self.revealed,
          FieldInfo{"full: whether background revealed by a departing object is removed, too"});
    visit("paper_jump_m",
          self.paper_jump_m,
          FieldInfo{"paper: difference from the previous frame at the same pixel that makes a jump "
                    "(tau2 of Fan 2020)",
                    "m",
                    0,
                    100});
  }
};

/// The pixels whose depth differs by more than `jump_m` from that of the same pixel in the previous
/// frame, without regard to the motion of the camera (Fan 2020, section III-A, Eqs. (6)-(7)).
/// Missing depth in the previous frame counts as depth 0, as there. A pixel without depth in the
/// current frame is not marked: it is 0 already, and Eq. (7) makes it 0.
[[nodiscard]] JumpImage depth_jumps(const DepthImage& current,
                                    const DepthImage& previous,
                                    double jump_m);

/// `depth` where it is known, else `other`. Both are of the same camera. Reuses the pixels of
/// `depth`.
[[nodiscard]] HalfDepth filled_from(HalfDepth depth, const HalfDepth& other);

/// Warps depth images of a camera from one pose to another, distortion included.
class DepthWarper {
 public:
  explicit DepthWarper(const CameraModel& camera);

  /// The depth of the nearest measured point of `previous` in each cell, without the pixels of
  /// `excluded`. `previous` has the camera's size; `excluded` has the same size or is empty.
  [[nodiscard]] HalfDepth warp(const DepthImage& previous,
                               const Eigen::Isometry3d& T_current_previous,
                               const Mask& excluded = {}) const;

 private:
  struct Row {
    std::int32_t* cell;  // out: cell number, row by row; one past the last for none
    float* z;            // metres; in and out
    std::size_t size;
  };
  void project_row(const Eigen::Matrix<float, 3, 4>& T,
                   const float* ray_x,
                   const float* ray_y,
                   const Row& row) const;
  template <class Lens>
  void project_row_with(Lens lens,
                        const Eigen::Matrix<float, 3, 4>& T,
                        const float* ray_x,
                        const float* ray_y,
                        const Row& row) const;

  CameraModel camera_;
  cv::Mat1f ray_x_, ray_y_;  // of the cells, x / z and y / z
};

/// The pixels at which the current depth is nearer, or farther, than all warped depth within two
/// pixels by more than jump_m + jump_per_m z^2. A static depth edge is thus no jump, although it
/// never falls on the same pixels twice. Missing depth is no jump. kWentFarther occurs only if
/// `revealed` is set.
[[nodiscard]] JumpImage depth_jumps(const DepthImage& current,
                                    const HalfDepth& expected,
                                    const DepthJumpConfig& config);

}  // namespace stillmap
