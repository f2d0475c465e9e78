// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

// The lens models as functions from a ray to its distorted position, both on the plane z = 1. They
// are templates, so that loops over pixels compile to code for single precision.

/// A position on the plane z = 1.
template <class Real>
struct LensPoint {
  Real x;  ///< to the right
  Real y;  ///< downwards
};

/// Brown-Conrady with the rational radial factor of OpenCV's calib3d. Branch-free, so that loops
/// vectorise.
template <class Real>
struct BrownConradyLens {
  Real k1, k2, p1, p2, k3, k4, k5, k6;  ///< as in CameraModel

  /// The lens of a camera of LensModel::kBrownConrady.
  explicit BrownConradyLens(const CameraModel& c)
      : k1(static_cast<Real>(c.k1)),
        k2(static_cast<Real>(c.k2)),
        p1(static_cast<Real>(c.p1)),
        p2(static_cast<Real>(c.p2)),
        k3(static_cast<Real>(c.k3)),
        k4(static_cast<Real>(c.k4)),
        k5(static_cast<Real>(c.k5)),
        k6(static_cast<Real>(c.k6)) {}

  /// The distorted position of a ray.
  [[nodiscard]] LensPoint<Real> operator()(Real x, Real y) const {
    const Real r2 = x * x + y * y;
    const Real radial =
        (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }
};

/// The equidistant fish-eye of OpenCV's fisheye (Kannala and Brandt 2006, Eq. 6): the angle between
/// ray and axis, not its tangent, gives the distance from the principal point.
template <class Real>
struct FisheyeLens {
  Real k1, k2, k3, k4;  ///< as in CameraModel

  /// The lens of a camera of LensModel::kFisheye.
  explicit FisheyeLens(const CameraModel& c)
      : k1(static_cast<Real>(c.k1)),
        k2(static_cast<Real>(c.k2)),
        k3(static_cast<Real>(c.k3)),
        k4(static_cast<Real>(c.k4)) {}

  /// The distance from the principal point for an angle, both as on the plane z = 1.
  [[nodiscard]] Real distance(Real angle_rad) const {
    const Real a2 = angle_rad * angle_rad;
    return angle_rad * (1 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4))));
  }

  /// The derivative of distance().
  [[nodiscard]] Real growth(Real angle_rad) const {
    const Real a2 = angle_rad * angle_rad;
    return 1 + a2 * (3 * k1 + a2 * (5 * k2 + a2 * (7 * k3 + a2 * 9 * k4)));
  }

  /// The distorted position of a ray.
  [[nodiscard]] LensPoint<Real> operator()(Real x, Real y) const {
    const Real r = std::sqrt(x * x + y * y);
    const Real scale = r > 0 ? distance(std::atan(r)) / r : Real(1);
    return {x * scale, y * scale};
  }
};

}  // namespace stillmap
