// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace stillmap {

/// Where a ray crosses a box's surface; t = infinity when it does not.
struct SlabHit {
  double t = std::numeric_limits<double>::infinity();
  int face = 0;
};

/// A ray in a box's own coordinates against |p[axis]| <= half_size[axis]: the entry from outside,
/// or with `from_inside` the exit. Only t > 0 counts, and a ray that starts inside a box seen from
/// outside does not meet it.
[[nodiscard]] inline SlabHit intersect_slabs(const Eigen::Vector3d& origin,
                                             const Eigen::Vector3d& direction,
                                             const Eigen::Vector3d& half_size,
                                             bool from_inside) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int enter_face = 0, leave_face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis];
    if (d == 0.0) {  // parallel: inside the slab everywhere or nowhere
      if (std::abs(origin[axis]) > half_size[axis]) return {};
      continue;
    }
    const double inverse = 1.0 / d;
    const double middle = -origin[axis] * inverse;
    const double reach = std::abs(half_size[axis] * inverse);
    const int positive = d > 0 ? 1 : 0;
    if (middle - reach > enter) {
      enter = middle - reach;
      enter_face = 2 * axis + 1 - positive;
    }
    if (middle + reach < leave) {
      leave = middle + reach;
      leave_face = 2 * axis + positive;
    }
  }
  if (enter > leave) return {};
  const double t = from_inside ? leave : enter;
  if (!(t > 0.0)) return {};
  return {t, from_inside ? leave_face : enter_face};
}

}  // namespace stillmap
