// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera.hpp"

#include <cmath>
#include <optional>
#include <tuple>

#include <Eigen/LU>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/geometry/lens.hpp"

namespace stillmap {
namespace {

constexpr double kConverged = 1e-12;  // on the plane z = 1

struct Distorted {
  Eigen::Vector2d position;
  Eigen::Matrix2d jacobian;
};

// The lens at a ray, with its derivative.
Distorted distort_with_jacobian(const BrownConradyLens<double>& c, const Eigen::Vector2d& n) {
  const double x = n.x(), y = n.y();
  const double r2 = x * x + y * y;
  const double above = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double below = 1.0 + r2 * (c.k4 + r2 * (c.k5 + r2 * c.k6));
  const double radial = above / below;
  const double d_above = c.k1 + r2 * (2.0 * c.k2 + 3.0 * r2 * c.k3);
  const double d_below = c.k4 + r2 * (2.0 * c.k5 + 3.0 * r2 * c.k6);
  const double d_radial = (d_above - radial * d_below) / below;  // d radial / d r2
  const LensPoint<double> position = c(x, y);
  Distorted d;
  d.position = {position.x, position.y};
  const double cross = 2.0 * x * y * d_radial + 2.0 * c.p1 * x + 2.0 * c.p2 * y;
  d.jacobian << radial + 2.0 * x * x * d_radial + 2.0 * c.p1 * y + 6.0 * c.p2 * x, cross, cross,
      radial + 2.0 * y * y * d_radial + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  return d;
}

// Newton's method; 3 to 5 rounds in practice. Nothing where it does not end at a ray on this side
// of a fold.
std::optional<Eigen::Vector2d> solve_from(const BrownConradyLens<double>& lens,
                                          Eigen::Vector2d n,
                                          const Eigen::Vector2d& raw) {
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Distorted d = distort_with_jacobian(lens, n);
    const Eigen::Vector2d step = d.jacobian.inverse() * (raw - d.position);
    if (!step.allFinite()) return std::nullopt;
    n += step;
    if (step.squaredNorm() < 1e-28) break;
  }
  const Distorted d = distort_with_jacobian(lens, n);
  const bool found = (d.position - raw).norm() < kConverged && d.jacobian.determinant() > 0;
  return found ? std::optional(n) : std::nullopt;
}

std::optional<Eigen::Vector2d> undistort_ray(const BrownConradyLens<double>& lens,
                                             const Eigen::Vector2d& raw) {
  if (const auto found = solve_from(lens, raw, raw)) return found;
  // A strong distortion may throw Newton's method over a fold. From the axis outwards each position
  // is near the one before.
  constexpr int kSteps = 32;
  std::optional<Eigen::Vector2d> n = Eigen::Vector2d::Zero();
  for (int i = 1; i <= kSteps && n; ++i) n = solve_from(lens, *n, raw * i / kSteps);
  return n;
}

// The angle in [low, high] whose distance is `distance`: Newton's method within a bracket.
double angle_between(const FisheyeLens<double>& lens, double low, double high, double distance) {
  double angle = 0.5 * (low + high);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double error = lens.distance(angle) - distance;
    (error > 0 ? high : low) = angle;
    double next = angle - error / lens.growth(angle);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - angle) < 1e-15) break;
    angle = next;
  }
  return angle;
}

std::optional<Eigen::Vector2d> undistort_ray(const FisheyeLens<double>& lens,
                                             const Eigen::Vector2d& raw) {
  constexpr int kSteps = 64;
  const double distance = raw.norm();
  if (distance == 0) return raw;
  const double greatest = std::atan(CameraModel::kSteepest);
  double low = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double high = greatest * i / kSteps;
    if (lens.distance(high) >= distance) {
      return raw / distance * std::tan(angle_between(lens, low, high, distance));
    }
    if (lens.distance(high) < lens.distance(low)) return std::nullopt;  // it folds back
    low = high;
  }
  return std::nullopt;
}

template <class Lens>
Eigen::Vector2d distort_with(const Lens& lens, const Eigen::Vector2d& n) {
  const LensPoint<double> d = lens(n.x(), n.y());
  return {d.x, d.y};
}

}  // namespace

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& ideal_px) const {
  if (!distorted()) return ideal_px;
  const Eigen::Vector2d n((ideal_px.x() - cx) / fx, (ideal_px.y() - cy) / fy);
  const Eigen::Vector2d d = lens == LensModel::kFisheye
                                ? distort_with(FisheyeLens<double>(*this), n)
                                : distort_with(BrownConradyLens<double>(*this), n);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& raw_px) const {
  if (!distorted()) return raw_px;
  const Eigen::Vector2d raw((raw_px.x() - cx) / fx, (raw_px.y() - cy) / fy);
  const std::optional<Eigen::Vector2d> found =
      lens == LensModel::kFisheye ? undistort_ray(FisheyeLens<double>(*this), raw)
                                  : undistort_ray(BrownConradyLens<double>(*this), raw);
  const Eigen::Vector2d n = found.value_or(raw.normalized() * kSteepest);
  return {fx * n.x() + cx, fy * n.y() + cy};
}

bool same_lens(const CameraModel& a, const CameraModel& b) {
  const auto values = [](const CameraModel& c) {
    const std::tuple size(c.width_px, c.height_px, c.fx, c.fy, c.cx, c.cy);
    return std::tuple_cat(size, std::tuple(c.lens, c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6));
  };
  return values(a) == values(b);
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
