// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/point_match.hpp"
#include "stillmap/slam/features/matcher.hpp"

namespace stillmap {

struct StaticMatchesConfig {
  bool enabled = true;
  double epipolar_px = 0.5;
  double reprojection_px = 3.0;
  double depth_m = 0.03;
  double depth_per_m = 0.02;
  int min_environment = 20;
  double min_parallax_px = 0.7;
  int iterations = 200;
  double search_px = 20;
  bool in_full = false;
  double inlier_px = 1.0;
  MatchRules match{.max_distance = 60, .max_ratio = 0.9};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"judge matches in the boxes of what moves"});
    visit("in_full", self.in_full, FieldInfo{"full: judge them as well"});
    visit(
        "epipolar_px",
        self.epipolar_px,
        FieldInfo{"a match farther from its epipolar line moves (tau5 of Fan 2020)", "px", 0, 50});
    visit("reprojection_px",
          self.reprojection_px,
          FieldInfo{"a match farther from where it would stand still moves", "px", 0, 50});
    visit("depth_m",
          self.depth_m,
          FieldInfo{"a match nearer or farther by more than that moves", "m", 0, 10});
    visit("depth_per_m",
          self.depth_per_m,
          FieldInfo{"growth of that distance with depth squared", "1/m", 0, 10});
    visit("min_environment",
          self.min_environment,
          FieldInfo{"matches outside of boxes that tell the camera's motion", "", 8, 10000});
    visit("min_parallax_px",
          self.min_parallax_px,
          FieldInfo{"less of it than that is a camera that only turns", "px", 0, 50});
    visit("iterations", self.iterations, FieldInfo{"of RANSAC, at most", "", 1, 100000});
    visit("search_px",
          self.search_px,
          FieldInfo{"how far a feature may be from where it would stand still", "px", 1, 200});
    visit("inlier_px",
          self.inlier_px,
          FieldInfo{"a match of the environment nearer to its epipolar line agrees with it",
                    "px",
                    0.01,
                    50});
    visit.group("match", self.match);
  }
};

/// What two frames say of the camera between them. Empty when they say nothing.
struct TwoViewGeometry {
  std::optional<Eigen::Matrix3d> F;    ///< none where the camera only turns
  std::optional<Eigen::Isometry3d> T;  ///< T_current_previous, when depth or a guess gives it
  std::optional<Eigen::Matrix3d> R;    ///< where there is no F: how the camera turns
  bool estimated = false;              ///< from the matches, not guessed
};

enum class MatchVerdict : std::uint8_t {
  kStatic,
  kDynamic,
  kUnknown,  ///< nothing is known that could tell
};

/// Fan 2020, section III-E: the geometry of two frames from matches in the environment region. F by
/// RANSAC, the motion from the depth of its inliers. A camera that only turns has no F. Where too
/// few match, the `expected_T_current_previous`, if there is one, stands in.
[[nodiscard]] TwoViewGeometry estimate_two_view(
    const CameraModel& camera,
    std::span<const PointMatch> environment,
    const std::optional<Eigen::Isometry3d>& expected_T_current_previous,
    const StaticMatchesConfig& config,
    std::mt19937& rng);

/// Fan 2020, Eqs. (15)-(17), for a match in the dynamic region: it moves when it is off its
/// epipolar line. What is on it may move along it, so the point's reprojection under the motion,
/// and its depth, must agree as well where they are known.
[[nodiscard]] MatchVerdict judge_match(const CameraModel& camera,
                                       const TwoViewGeometry& geometry,
                                       const PointMatch& match,
                                       const StaticMatchesConfig& config);

}  // namespace stillmap
