// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// Constant velocity: the motion between the last two frames continues, in proportion to time.
class MotionModel {
 public:
  /// Observes that the camera moved by `T_before_after` in `duration_s`.
  void set(const Eigen::Isometry3d& T_before_after, double duration_s) {
    T_before_after_ = T_before_after;
    duration_s_ = duration_s;
  }
  void reset() { set(Eigen::Isometry3d::Identity(), 0); }

  /// The motion predicted for the next `duration_s`; the identity before the first observation. A
  /// gap in the sequence is bridged for the length of a few frames only, since speeds change.
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
