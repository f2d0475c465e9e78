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
  kNoJump = 0,       ///< as before, or missing now or before
  kCameNearer = 1,   ///< something stands where there was nothing
  kWentFarther = 2,  ///< what stood there is gone
};

/// Where depth has changed suddenly: a DepthJump for each pixel of an image.
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

/// Fan 2020, Eqs. (6)-(7): where the depth of a pixel differs from that of the same pixel before by
/// more than `jump_m`, whatever the camera did in between. Missing depth is no jump.
[[nodiscard]] JumpImage depth_jumps(const DepthImage& current,
                                    const DepthImage& previous,
                                    double jump_m);

/// `depth` where it knows something, else `other`. Both of the same camera. May write to the pixels
/// of `depth`, which is taken over.
[[nodiscard]] HalfDepth filled_from(HalfDepth depth, const HalfDepth& other);

/// Warps depth images of a camera, distortion included, from one pose of it to another.
class DepthWarper {
 public:
  explicit DepthWarper(const CameraModel& camera);

  /// The depth of the nearest measured point of `previous` at each cell. The pixels of `excluded`
  /// are left out. `previous` has the camera's size, `excluded` the same or none.
  [[nodiscard]] HalfDepth warp(const DepthImage& previous,
                               const Eigen::Isometry3d& T_current_previous,
                               const Mask& excluded = {}) const;

 private:
  struct Row {
    std::int32_t* cell;  // out: its number, row by row; that after the last for none
    float* z;            // metres; in and out
    std::size_t size;
  };
  void project_row(const Eigen::Matrix<float, 3, 4>& T,
                   const float* ray_x,
                   const float* ray_y,
                   const Row& row) const;

  CameraModel camera_;
  cv::Mat1f ray_x_, ray_y_;  // of the cells, x / z and y / z
};

/// Where the current depth is nearer, or farther, than all of the warped depth within two pixels,
/// by more than jump_m + jump_per_m z^2. So a depth edge that stands still is no jump, although it
/// never falls on the same pixels twice. Missing depth is no jump. kWentFarther only if `revealed`.
[[nodiscard]] JumpImage depth_jumps(const DepthImage& current,
                                    const HalfDepth& expected,
                                    const DepthJumpConfig& config);

}  // namespace stillmap
