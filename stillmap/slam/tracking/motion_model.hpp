// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// Constant velocity: the motion between the last two frames goes on, in proportion to the time.
class MotionModel {
 public:
  /// The camera was at `T_before_after` of its earlier place after `duration_s`.
  void set(const Eigen::Isometry3d& T_before_after, double duration_s) {
    T_before_after_ = T_before_after;
    duration_s_ = duration_s;
  }
  void reset() { set(Eigen::Isometry3d::Identity(), 0); }

  /// The motion expected in the next `duration_s`; none when nothing is known yet. A gap in the
  /// sequence is bridged for a few frames' length only: nothing keeps its speed for long.
  [[nodiscard]] Eigen::Isometry3d predict(double duration_s) const {
    if (duration_s_ <= 0) return Eigen::Isometry3d::Identity();
    constexpr double kMaxRatio = 3.0;
    const double ratio = std::clamp(duration_s / duration_s_, 0.0, kMaxRatio);
    return interpolate(Eigen::Isometry3d::Identity(), T_before_after_, ratio);
  }

 private:
  Eigen::Isometry3d T_before_after_ = Eigen::Isometry3d::Identity();
  double duration_s_ = 0;
};

}  // namespace stillmap
