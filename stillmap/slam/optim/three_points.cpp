// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/three_points.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {

bool same_shape(const PointTriple& a, const PointTriple& b) {
  constexpr double kMinBaseline_m = 0.1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double la = (a[i] - a[j]).norm(), lb = (b[i] - b[j]).norm();
    const double z = std::max({a[i].z(), a[j].z(), b[i].z(), b[j].z()});
    if (la < kMinBaseline_m || std::abs(la - lb) > 0.05 * la + 0.02 * z * z) return false;
  }
  return true;
}

bool near_measurement(const CameraModel& camera,
                      const PointMeasurement& measurement,
                      const Eigen::Vector3d& p_camera) {
  constexpr double kSlack = 4.0;  // factor on the squared error
  return p_camera.z() >= kMinPointDepth &&
         reprojection_residual(camera, measurement, p_camera).squaredNorm() <=
             kSlack * chi2_bound(measurement);
}

}  // namespace stillmap
