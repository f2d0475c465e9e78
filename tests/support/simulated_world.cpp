// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_world.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace stillmap {
namespace {

constexpr int kLevels = 8;
constexpr double kScaleFactor = 1.2;
constexpr double kNearest_m = 0.2;

double uniform(std::mt19937& rng, double low, double high) {
  return low + (high - low) * static_cast<double>(rng()) / 4294967296.0;
}

// Half of the points on the box, half inside of it but not near its middle.
Eigen::Vector3d random_place(const Eigen::Vector3d& half_size, std::mt19937& rng) {
  const bool inside = rng() % 2U == 0U;
  const auto wall = static_cast<int>(rng() % 3U);
  const double side = rng() % 2U == 0U ? -1.0 : 1.0;
  Eigen::Vector3d p;
  do {
    for (int axis = 0; axis < 3; ++axis) p[axis] = uniform(rng, -half_size[axis], half_size[axis]);
  } while (inside && p.norm() < 1.2);
  if (!inside) p[wall] = side * half_size[wall];
  return p;
}

// The level at which the corner fills one pixel of the level; nothing outside the pyramid.
std::optional<std::uint8_t> level_at(const WorldPoint& point, double distance_m) {
  const double level =
      std::round(std::log(point.base_distance_m / distance_m) / std::log(kScaleFactor));
  if (level < 0 || level >= kLevels) return std::nullopt;
  return static_cast<std::uint8_t>(level);
}

bool near_image(const CameraModel& camera, const Eigen::Vector2d& px) {
  constexpr double kMargin_px = 50;
  return px.x() > -kMargin_px && px.x() < camera.width_px + kMargin_px && px.y() > -kMargin_px &&
         px.y() < camera.height_px + kMargin_px;
}

void flip_bits(Descriptor& descriptor, int count, std::mt19937& rng) {
  for (int i = 0; i < count; ++i) {
    const std::uint32_t bit = rng() % static_cast<std::uint32_t>(kDescriptorBits);
    descriptor[bit / 64U] ^= std::uint64_t{1} << (bit % 64U);
  }
}

}  // namespace

Descriptor random_descriptor(std::mt19937& rng) {
  Descriptor descriptor{};
  for (std::uint64_t& word : descriptor) {
    word = static_cast<std::uint64_t>(rng()) << 32U;
    word |= rng();
  }
  return descriptor;
}

CameraModel simulated_camera() {
  return {"simulated", 640, 480, 525.0, 520.0, 319.5, 241.0};
}

const SimulatedWorld& simulated_world() {
  static const SimulatedWorld kWorld({}, simulated_camera());
  return kWorld;
}

SimulatedWorld::SimulatedWorld(const Config& config, const CameraModel& camera) : camera_(camera) {
  for (int level = 0; level < kLevels; ++level) {
    level_scales_.push_back(static_cast<float>(std::pow(kScaleFactor, level)));
  }
  std::mt19937 rng(config.seed);
  for (int i = 0; i < config.points; ++i) {
    WorldPoint point;
    point.position = random_place(config.half_size_m, rng);
    point.descriptor = random_descriptor(rng);
    if (config.kinds > 0 && i >= config.kinds) {
      point.descriptor = points_[static_cast<std::size_t>(i % config.kinds)].descriptor;
    }
    point.angle_deg = static_cast<float>(uniform(rng, 0, 360));
    // From a standing camera in the middle all levels occur.
    point.base_distance_m = point.position.norm() * uniform(rng, 1.2, 2.5);
    points_.push_back(point);
  }
}

Observed SimulatedWorld::observe(const Eigen::Isometry3d& T_world_camera,
                                 const ObservationNoise& noise,
                                 std::mt19937& rng) const {
  const CameraPath standing = [&](double) { return T_world_camera; };
  return observe_rolling(standing, 0.0, 0.0, noise, rng);
}

Observed SimulatedWorld::observe_rolling(const CameraPath& path,
                                         double time_s,
                                         double readout_s,
                                         const ObservationNoise& noise,
                                         std::mt19937& rng) const {
  const Eigen::Isometry3d T_camera_world = path(time_s).inverse();
  Observed observed;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    Eigen::Vector3d p_camera = T_camera_world * points_[i].position;
    // The row decides the instant, which decides the row: a contraction, for rows pass much faster
    // than points move.
    double last_row = 0;
    for (int round = 0; round < 20 && readout_s > 0 && p_camera.z() > kNearest_m; ++round) {
      const Eigen::Vector2d px = camera_.distort(camera_.project(p_camera));
      const double row = px.y() / camera_.height_px - 0.5;
      if (!near_image(camera_, px) || std::abs(row - last_row) < 1e-9) break;
      p_camera = path(time_s + readout_s * row).inverse() * points_[i].position;
      last_row = row;
    }
    if (p_camera.z() > kNearest_m) append(p_camera, i, noise, rng, observed);
  }
  Features& features = observed.features;
  features.px = features.ideal_px;
  features.depth_m = features.sensor_depth_m;
  features.grid = FeatureGrid(features.px, camera_.width_px, camera_.height_px);
  return observed;
}

void SimulatedWorld::append(const Eigen::Vector3d& p_camera,
                            std::uint32_t point,
                            const ObservationNoise& noise,
                            std::mt19937& rng,
                            Observed& observed) const {
  const WorldPoint& source = points_[point];
  const std::optional<std::uint8_t> level = level_at(source, p_camera.norm());
  const Eigen::Vector2d ideal = camera_.project(p_camera);
  const bool near_image = ideal.x() > -50 && ideal.x() < camera_.width_px + 50 && ideal.y() > -50 &&
                          ideal.y() < camera_.height_px + 50;
  if (!level || !near_image) return;
  const double sigma_px = noise.pixel_sigma_px * static_cast<double>(level_scales_[*level]);
  std::normal_distribution<double> normal;
  const double off_y = normal(rng), off_x = normal(rng);  // as arguments, in each compiler's order
  const Eigen::Vector2d raw = camera_.distort(ideal) + sigma_px * Eigen::Vector2d(off_x, off_y);
  if (raw.x() < 0 || raw.x() >= camera_.width_px || raw.y() < 0 || raw.y() >= camera_.height_px) {
    return;
  }
  const double inverse_depth =
      std::max(1.0 / p_camera.z() + noise.inverse_depth_sigma * normal(rng), 0.02);
  Descriptor descriptor = source.descriptor;
  flip_bits(descriptor, noise.flipped_bits, rng);
  if (uniform(rng, 0, 1) < noise.wrong_descriptor_share) descriptor = random_descriptor(rng);
  const bool has_depth = uniform(rng, 0, 1) >= noise.missing_depth_share;

  Features& features = observed.features;
  features.raw_px.push_back(raw.cast<float>());
  features.ideal_px.push_back(camera_.undistort(raw).cast<float>());
  features.sensor_depth_m.push_back(has_depth ? static_cast<float>(1.0 / inverse_depth) : 0.0F);
  features.level.push_back(*level);
  features.angle_deg.push_back(source.angle_deg);
  features.descriptors.push_back(descriptor);
  observed.points.push_back(point);
}

}  // namespace stillmap
