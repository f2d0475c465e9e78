// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera.hpp"

#include <Eigen/LU>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

struct Distorted {
  Eigen::Vector2d position;
  Eigen::Matrix2d jacobian;
};

// Brown-Conrady on normalised coordinates, with its derivative.
Distorted distort_normalized(const CameraModel& c, const Eigen::Vector2d& n) {
  const double x = n.x(), y = n.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double d_radial = c.k1 + r2 * (2.0 * c.k2 + 3.0 * r2 * c.k3);  // d radial / d r2
  Distorted d;
  d.position = {x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x),
                y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y};
  const double cross = 2.0 * x * y * d_radial + 2.0 * c.p1 * x + 2.0 * c.p2 * y;
  d.jacobian << radial + 2.0 * x * x * d_radial + 2.0 * c.p1 * y + 6.0 * c.p2 * x, cross, cross,
      radial + 2.0 * y * y * d_radial + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  return d;
}

}  // namespace

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& ideal_px) const {
  if (!distorted()) return ideal_px;
  const Eigen::Vector2d n((ideal_px.x() - cx) / fx, (ideal_px.y() - cy) / fy);
  const Eigen::Vector2d d = distort_normalized(*this, n).position;
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& raw_px) const {
  if (!distorted()) return raw_px;
  const Eigen::Vector2d raw((raw_px.x() - cx) / fx, (raw_px.y() - cy) / fy);
  Eigen::Vector2d n = raw;
  for (int iteration = 0; iteration < 20; ++iteration) {  // Newton; 3 to 5 rounds in practice
    const Distorted d = distort_normalized(*this, n);
    const Eigen::Vector2d step = d.jacobian.inverse() * (raw - d.position);
    if (!step.allFinite()) break;
    n += step;
    if (step.squaredNorm() < 1e-28) break;
  }
  return {fx * n.x() + cx, fy * n.y() + cy};
}

CameraModel builtin_camera(std::string_view name) {
  for (const std::string& known : builtin_camera_names()) {
    if (known != name) continue;
    if (name == "tum_fr1") {
      return {"tum_fr1",
              640,
              480,
              517.306408,
              516.469215,
              318.643040,
              255.313989,
              0.262383,
              -0.953104,
              -0.005358,
              0.002628,
              1.163314,
              5000};
    }
    if (name == "tum_fr2") {
      return {"tum_fr2",
              640,
              480,
              520.908620,
              521.007327,
              325.141442,
              249.701764,
              0.231222,
              -0.784899,
              -0.003257,
              -0.000105,
              0.917205,
              5000};
    }
    if (name == "bonn") {
      return {"bonn",
              640,
              480,
              542.822841,
              542.576870,
              315.593520,
              237.756098,
              0.039903,
              -0.099343,
              -0.000730,
              -0.000144,
              0,
              5000};
    }
    return {"tum_fr3", 640, 480, 535.4, 539.2, 320.1, 247.6, 0, 0, 0, 0, 0, 5000};
  }
  throw Error("unknown camera '{}': {}", name, name_hint(name, builtin_camera_names()));
}

std::vector<std::string> builtin_camera_names() {
  return {"tum_fr1", "tum_fr2", "tum_fr3", "bonn"};
}

cv::Mat2f pixel_rays(const CameraModel& camera) {
  cv::Mat2f rays(camera.height_px, camera.width_px);
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      const Eigen::Vector3d ray =
          camera.unproject(camera.undistort({static_cast<double>(u), static_cast<double>(v)}), 1.0);
      rays(v, u) = {static_cast<float>(ray.x()), static_cast<float>(ray.y())};
    }
  }
  return rays;
}

}  // namespace stillmap
