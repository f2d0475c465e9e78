// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/static_matches.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stillmap/geometry/epipolar.hpp"
#include "stillmap/geometry/ray_rotation.hpp"
#include "stillmap/geometry/relative_motion.hpp"

namespace stillmap {
namespace {

// A predicted translation shorter than this does not determine an epipolar line.
constexpr double kShortGuessM = 0.005;

TwoViewGeometry guessed_geometry(const CameraModel& camera,
                                 const std::optional<Eigen::Isometry3d>& T) {
  TwoViewGeometry geometry;
  if (!T) return geometry;
  geometry.judge = MatchJudge::kPrediction;
  geometry.T = T;
  if (T->translation().norm() >= kShortGuessM) {
    geometry.F = fundamental_of_motion(camera, *T);
  } else {
    geometry.R = T->linear();
  }
  return geometry;
}

/// The rotation, when it explains the matches without any translation.
std::optional<Eigen::Matrix3d> pure_rotation(const CameraModel& camera,
                                             std::span<const PointMatch> matches,
                                             double min_parallax_px) {
  const Eigen::Matrix3d R = ray_rotation(camera, matches);
  std::vector<double> residuals;
  residuals.reserve(matches.size());
  for (const PointMatch& match : matches) {
    residuals.push_back(rotation_residual_px(camera, R, match));
  }
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::ranges::nth_element(residuals, middle);
  if (*middle >= min_parallax_px) return std::nullopt;
  return R;
}

/// Whether the point is where a static point would be.
bool stands_still(const CameraModel& camera,
                  const Eigen::Isometry3d& T_current_previous,
                  const PointMatch& match,
                  const StaticMatchesConfig& config) {
  const Eigen::Vector3d p =
      T_current_previous * camera.unproject(match.previous_px, match.previous_depth_m);
  if (!(p.z() > 0)) return false;
  if ((camera.project(p) - match.current_px).norm() > config.reprojection_px) return false;
  if (!(match.current_depth_m > 0)) return true;
  const double bound = config.depth_m + config.depth_per_m * p.z() * p.z();
  return std::abs(p.z() - match.current_depth_m) <= bound;
}

MatchVerdict verdict(bool still) {
  return still ? MatchVerdict::kStatic : MatchVerdict::kDynamic;
}

}  // namespace

TwoViewGeometry estimate_two_view(
    const CameraModel& camera,
    std::span<const PointMatch> environment,
    const std::optional<Eigen::Isometry3d>& expected_T_current_previous,
    const StaticMatchesConfig& config,
    std::mt19937& rng) {
  if (std::ssize(environment) < config.min_environment) {
    return guessed_geometry(camera, expected_T_current_previous);
  }
  TwoViewGeometry geometry;
  geometry.judge = MatchJudge::kRotation;
  if (config.min_parallax_px > 0) {
    geometry.R = pure_rotation(camera, environment, config.min_parallax_px);
  }
  std::vector<PointMatch> fitting(environment.begin(), environment.end());
  if (!geometry.R) {
    // The bound is that of a good match, independent of the bound for judged matches.
    const std::optional<FundamentalEstimate> estimate =
        estimate_fundamental(environment, config.inlier_px, config.iterations, rng);
    if (!estimate || estimate->inliers < config.min_environment) {
      return guessed_geometry(camera, expected_T_current_previous);
    }
    geometry.judge = MatchJudge::kFundamental;
    geometry.F = estimate->F;
    if (!config.motion_check) return geometry;
    fitting.clear();
    for (std::size_t i = 0; i < environment.size(); ++i) {
      if (estimate->inlier[i] != 0) fitting.push_back(environment[i]);
    }
  }
  const Eigen::Isometry3d start =
      expected_T_current_previous.value_or(Eigen::Isometry3d::Identity());
  geometry.T = relative_motion(camera, fitting, start, config.min_environment);
  return geometry;
}

MatchVerdict judge_match(const CameraModel& camera,
                         const TwoViewGeometry& geometry,
                         const PointMatch& match,
                         const StaticMatchesConfig& config) {
  const double line_px = geometry.estimated() ? config.epipolar_px : config.reprojection_px;
  if (geometry.F && epipolar_distance(*geometry.F, match) > line_px) return MatchVerdict::kDynamic;
  if (geometry.T && match.previous_depth_m > 0) {
    return verdict(stands_still(camera, *geometry.T, match, config));
  }
  if (geometry.F) return MatchVerdict::kStatic;
  if (geometry.R) {
    return verdict(rotation_residual_px(camera, *geometry.R, match) <= config.reprojection_px);
  }
  return MatchVerdict::kUnknown;
}

}  // namespace stillmap
