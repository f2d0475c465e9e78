// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/point_match.hpp"

namespace stillmap {

/// The distance of p_C from the epipolar line F p_P, pixels (Fan 2020, section III-F, Eqs.
/// (15)-(16)). 0 if F gives no line.
[[nodiscard]] double epipolar_distance(const Eigen::Matrix3d& F, const PointMatch& match);

/// The fundamental matrix of two views of a camera: p_C^T F p_P = 0 for static points. Zero for a
/// motion without translation.
[[nodiscard]] Eigen::Matrix3d fundamental_of_motion(const CameraModel& camera,
                                                    const Eigen::Isometry3d& T_current_previous);

/// The best fundamental matrix, of rank 2, for at least eight matches: Hartley's normalised
/// eight-point algorithm. Nothing for fewer matches.
[[nodiscard]] std::optional<Eigen::Matrix3d> eight_point(std::span<const PointMatch> matches);

struct FundamentalEstimate {
  Eigen::Matrix3d F;
  std::vector<std::uint8_t> inlier;  ///< per match
  int inliers = 0;
};

/// RANSAC over eight_point(), refined over the inliers: matches within `bound_px` of their epipolar
/// line. Nothing for fewer than eight matches or eight inliers. The same `rng` gives the same bits.
[[nodiscard]] std::optional<FundamentalEstimate> estimate_fundamental(
    std::span<const PointMatch> matches, double bound_px, int max_iterations, std::mt19937& rng);

}  // namespace stillmap
