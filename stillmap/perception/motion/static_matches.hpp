// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/status.hpp"
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
  double min_parallax_px = 0;
  bool motion_check = false;
  std::string unmatched = "keep";
  double moving_share = 0.3;
  int iterations = 200;
  double search_px = 20;
  bool in_full = false;
  double inlier_px = 1.0;
  MatchRules match{.max_distance = 60, .max_ratio = 0.9};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled",
          self.enabled,
          FieldInfo{
              "whether features in the boxes of dynamic objects are judged by epipolar geometry"});
    visit("in_full", self.in_full, FieldInfo{"whether mode full judges them, too"});
    visit("epipolar_px",
          self.epipolar_px,
          FieldInfo{"distance from the epipolar line above which a match moves (tau5 of Fan 2020)",
                    "px",
                    0,
                    50});
    visit(
        "reprojection_px",
        self.reprojection_px,
        FieldInfo{"distance from its static reprojection above which a match moves", "px", 0, 50});
    visit("depth_m",
          self.depth_m,
          FieldInfo{"difference from its static depth above which a match moves", "m", 0, 10});
    visit("depth_per_m",
          self.depth_per_m,
          FieldInfo{"growth of depth_m with depth squared", "1/m", 0, 10});
    visit("min_environment",
          self.min_environment,
          FieldInfo{"number of matches in the environment region needed for the camera's motion",
                    "",
                    8,
                    10000});
    visit("min_parallax_px",
          self.min_parallax_px,
          FieldInfo{"parallax below which the camera counts as one that only rotates, without a "
                    "fundamental matrix; 0: there is always one (Fan 2020)",
                    "px",
                    0,
                    50});
    visit("motion_check",
          self.motion_check,
          FieldInfo{"whether a match on its epipolar line must, too, be where a static point would "
                    "be: points may move along the line (not in Fan 2020)"});
    visit(
        "unmatched",
        self.unmatched,
        FieldInfo{"treatment of a feature in the box of a dynamic object that has no match in the "
                  "previous frame (drop in Fan 2020)",
                  "",
                  0,
                  0,
                  {"keep", "drop"}});
    visit("moving_share",
          self.moving_share,
          FieldInfo{"ds-slam: share of the matches on an object farther than inlier_px from their "
                    "epipolar lines above which the object moves",
                    "",
                    0,
                    1});
    matching_fields(self, visit);
  }

 private:
  template <class Self, class Visitor>
  static void matching_fields(Self& self, Visitor& visit) {
    visit("iterations",
          self.iterations,
          FieldInfo{"greatest number of RANSAC iterations", "", 1, 100000});
    visit("search_px",
          self.search_px,
          FieldInfo{"search radius for a match around its static reprojection", "px", 1, 200});
    visit("inlier_px",
          self.inlier_px,
          FieldInfo{"distance from the epipolar line within which a match of the environment "
                    "region is an inlier",
                    "px",
                    0.01,
                    50});
    visit.group("match", self.match);
  }
};

/// The motion of the camera between two frames. Empty if the matches do not determine it.
struct TwoViewGeometry {
  std::optional<Eigen::Matrix3d> F;    ///< none if the camera only rotates
  std::optional<Eigen::Isometry3d> T;  ///< T_current_previous, if it is needed and known
  std::optional<Eigen::Matrix3d> R;    ///< the rotation, if there is no F
  MatchJudge judge = MatchJudge::kNothing;

  /// Whether the matches determined it.
  [[nodiscard]] bool estimated() const {
    return judge == MatchJudge::kFundamental || judge == MatchJudge::kRotation;
  }
};

enum class MatchVerdict : std::uint8_t {
  kStatic,
  kDynamic,
  kUnknown,  ///< not enough is known
};

/// The geometry of two frames from matches in the environment region (Fan 2020, section III-F): F
/// by RANSAC. A camera that only rotates has no F if `min_parallax_px` asks for it. The motion
/// comes from the depth of the inliers where there is no F, or `motion_check` asks for it. With
/// fewer than `min_environment` matches or inliers `expected_T_current_previous`, if given, is used
/// instead.
[[nodiscard]] TwoViewGeometry estimate_two_view(
    const CameraModel& camera,
    std::span<const PointMatch> environment,
    const std::optional<Eigen::Isometry3d>& expected_T_current_previous,
    const StaticMatchesConfig& config,
    std::mt19937& rng);

/// The verdict on a match in the dynamic region (Fan 2020, section III-F, Eqs. (15)-(17)): it moves
/// if it is farther than `epipolar_px` from its epipolar line. Without an F from matches, or with
/// `motion_check`, the reprojection under the motion, and the depth, must agree, too, if they are
/// known.
[[nodiscard]] MatchVerdict judge_match(const CameraModel& camera,
                                       const TwoViewGeometry& geometry,
                                       const PointMatch& match,
                                       const StaticMatchesConfig& config);

}  // namespace stillmap
