// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// What a pixel of an image of jumps says.
enum DepthJump : std::uint8_t {
  kNoJump = 0,       ///< as before, or missing now or before
  kCameNearer = 1,   ///< something stands where there was nothing
  kWentFarther = 2,  ///< what stood there is gone
};

struct DepthJumpConfig {
  bool enabled = true;
  double jump_m = 0.1;
  double jump_per_m = 0.01;
  bool revealed = false;
  double paper_jump_m = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"remove what suddenly has another depth"});
    visit("jump_m",
          self.jump_m,
          FieldInfo{"change of depth against the warped frame before, besides noise", "m", 0, 100});
    visit("jump_per_m",
          self.jump_per_m,
          FieldInfo{"growth of that change with depth squared", "1/m", 0, 10});
    visit("revealed",
          self.revealed,
          FieldInfo{"also remove what came into view behind something that left"});
    visit("paper_jump_m",
          self.paper_jump_m,
          FieldInfo{"paper: change of depth at a pixel (tau2 of Fan 2020)", "m", 0, 100});
  }
};

/// Fan 2020, Eqs. (6)-(7): where the depth of a pixel differs from that of the same pixel before by
/// more than `jump_m`, whatever the camera did in between. Missing depth is no jump.
[[nodiscard]] cv::Mat1b depth_jumps(const DepthImage& current,
                                    const DepthImage& previous,
                                    double jump_m);

/// Depth as it would be measured from elsewhere, for every second pixel of every second row of the
/// image: cell (r, c) is pixel (2r, 2c). 0 where nothing is known.
struct WarpedDepth {
  cv::Mat1f mat;

  /// Takes what `other` knows where this knows nothing. Both of the same camera; an empty one knows
  /// nothing.
  void fill_from(const WarpedDepth& other);
};

/// Warps depth images of a camera, distortion included, from one pose of it to another.
class DepthWarper {
 public:
  explicit DepthWarper(const CameraModel& camera);

  /// The nearest measured point of `previous` at each cell, without the pixels that are not 0 in
  /// `without`. `previous` has the camera's size, `without` the same or none.
  [[nodiscard]] WarpedDepth warp(const DepthImage& previous,
                                 const Eigen::Isometry3d& T_current_previous,
                                 const cv::Mat1b& without = {}) const;

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
[[nodiscard]] cv::Mat1b depth_jumps(const DepthImage& current,
                                    const WarpedDepth& expected,
                                    const DepthJumpConfig& config);

}  // namespace stillmap
