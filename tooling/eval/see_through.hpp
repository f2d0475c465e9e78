// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A frame sees through a point when it measures surface behind it by more than this, metres, ...
inline constexpr double kSeeThroughMargin_m = 0.05;
/// ... and by this many standard deviations of the measured depth, which are ...
inline constexpr double kSeeThroughSigmas = 3;
/// ... this times the square of the depth, 1/m.
inline constexpr double kDepthSigma = 0.0015;
/// The number of frames seeing through a point that prove the point wrong.
inline constexpr std::size_t kSeeThroughFrames = 3;

/// The residue of a map: points that frames prove wrong.
struct Residue {
  std::size_t points = 0;        ///< points of the map
  std::size_t seen_through = 0;  ///< points seen through by at least kSeeThroughFrames frames
  /// Those of them that no fewer frames measure than see through: surface, but noise and the rims
  /// of objects let frames see through it now and then. So does a person who stood there most of
  /// the time and then left.
  std::size_t by_noise = 0;
  std::size_t frames = 0;

  /// The share of the points that are seen through; 0 without points.
  [[nodiscard]] double ratio() const { return share(seen_through); }
  /// The part of ratio() that the frames themselves make: a map without any fault has it, too.
  [[nodiscard]] double noise_floor() const { return share(by_noise); }

 private:
  [[nodiscard]] double share(std::size_t count) const {
    return points > 0 ? static_cast<double>(count) / static_cast<double>(points) : 0.0;
  }
};

/// Tests a map against the depth images of a sequence. Needs no truth.
class SeeThroughTest {
 public:
  /// `points` are finite and in the world frame of the frames' poses.
  SeeThroughTest(const CameraModel& camera, std::vector<Eigen::Vector3f> points_world);

  /// Counts one frame. `depth` has the camera's size. The measured depth at a point is that of the
  /// raw pixel whose centre is nearest to the projected point.
  void add(const DepthImage& depth, const Eigen::Isometry3d& T_world_camera);

  [[nodiscard]] Residue result() const;

 private:
  /// How often frames looked at a point.
  struct Looks {
    std::uint16_t through = 0;  ///< and saw surface behind it
    std::uint16_t at = 0;       ///< and measured it, as far as noise lets them
  };

  void look(const DepthImage& depth, const Eigen::Vector3d& p_camera, Looks& looks) const;

  CameraModel camera_;
  Eigen::AlignedBox2d ideal_image_px_;  ///< bounds of the ideal pixels of the image
  std::vector<Eigen::Vector3f> points_;
  std::vector<Looks> looks_;  ///< at each point
  std::size_t frames_ = 0;
};

}  // namespace stillmap
