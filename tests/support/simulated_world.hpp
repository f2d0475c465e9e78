// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// A point of the simulated world: a corner with a size, so that it is found on the pyramid's
/// level 0 at `base_distance_m` and on coarser levels nearer by.
struct WorldPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Descriptor descriptor{};
  float angle_deg = 0;
  double base_distance_m = 0;
};

/// The faults of observations. All zero: exact.
struct ObservationNoise {
  double pixel_sigma_px = 0;          ///< on level 0; grows with the level's scale
  double inverse_depth_sigma = 0;     ///< 1/m
  double missing_depth_share = 0;     ///< features whose depth is unknown
  double wrong_descriptor_share = 0;  ///< features with unknown descriptors
  int flipped_bits = 0;               ///< of each descriptor
};

/// Features of one image with their truth.
struct Observed {
  Features features;
  std::vector<std::uint32_t> points;  ///< per feature, the index of the world's point
};

/// Pose of the camera in the world at a time in seconds.
using CameraPath = std::function<Eigen::Isometry3d(double)>;

/// Random points on the walls, floor and ceiling of a box and inside of it (at least 1.2 m from its
/// middle), each with a descriptor, and a camera that observes them without images. There is no
/// occlusion.
class SimulatedWorld {
 public:
  struct Config {
    Eigen::Vector3d half_size_m{2.5, 1.5, 3.0};  ///< of the box, whose middle is the origin
    int points = 5000;
    int kinds = 0;  ///< number of different descriptors among the points; 0 = one per point
    std::uint32_t seed = 1;
  };

  SimulatedWorld(const Config& config, const CameraModel& camera);

  /// The observations from `T_world_camera`, in the order of the points.
  [[nodiscard]] Observed observe(const Eigen::Isometry3d& T_world_camera,
                                 const ObservationNoise& noise,
                                 std::mt19937& rng) const;

  /// The same through a rolling shutter: the middle row is read at `time_s`, row v of h rows at
  /// `time_s + readout_s * (v / h - 1/2)`, and each point is seen from where the camera is then.
  [[nodiscard]] Observed observe_rolling(const CameraPath& path,
                                         double time_s,
                                         double readout_s,
                                         const ObservationNoise& noise,
                                         std::mt19937& rng) const;

  [[nodiscard]] const std::vector<WorldPoint>& points() const { return points_; }
  [[nodiscard]] const CameraModel& camera() const { return camera_; }
  [[nodiscard]] const std::vector<float>& level_scales() const { return level_scales_; }

 private:
  void append(const Eigen::Vector3d& p_camera,
              std::uint32_t point,
              const ObservationNoise& noise,
              std::mt19937& rng,
              Observed& observed) const;

  CameraModel camera_;
  std::vector<float> level_scales_;
  std::vector<WorldPoint> points_;
};

/// A descriptor of 256 fair coins: two differ in about 128 bits.
[[nodiscard]] Descriptor random_descriptor(std::mt19937& rng);

/// An undistorted camera of 640 x 480 pixels.
[[nodiscard]] CameraModel simulated_camera();

/// The world of most tests: no setting changed, seen by `simulated_camera()`.
[[nodiscard]] const SimulatedWorld& simulated_world();

}  // namespace stillmap
