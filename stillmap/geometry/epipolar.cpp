// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/epipolar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "stillmap/geometry/ransac.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
constexpr std::size_t kSample = 8;

/// Moves points to their centroid, at a mean distance of sqrt(2).
struct Normalizer {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double scale = 1;

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector2d& px) const {
    return ((px - centre) * scale).homogeneous();
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << scale, 0, -scale * centre.x(), 0, scale, -scale * centre.y(), 0, 0, 1;
    return m;
  }
};

Normalizer normalizer(std::span<const PointMatch> matches, Eigen::Vector2d PointMatch::*side) {
  Normalizer result;
  const auto n = static_cast<double>(matches.size());
  for (const PointMatch& match : matches) result.centre += match.*side / n;
  double distance = 0;
  for (const PointMatch& match : matches) distance += (match.*side - result.centre).norm() / n;
  if (distance > 0) result.scale = std::sqrt(2.0) / distance;
  return result;
}

Eigen::Matrix3d rank_two(const Eigen::Matrix3d& F) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d values = svd.singularValues();
  values(2) = 0;
  return svd.matrixU() * values.asDiagonal() * svd.matrixV().transpose();
}

/// How well matches agree with a fundamental matrix.
struct Agreement {
  std::vector<std::uint8_t> inlier;
  int inliers = 0;
  double cost = std::numeric_limits<double>::infinity();  // truncated squares

  friend bool operator<(const Agreement& a, const Agreement& b) { return a.cost > b.cost; }
};

Agreement agreement_with(const Eigen::Matrix3d& F,
                         std::span<const PointMatch> matches,
                         double bound_px) {
  Agreement result{std::vector<std::uint8_t>(matches.size(), 0), 0, 0};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double d = epipolar_distance(F, matches[i]);
    const bool fits = d <= bound_px;
    result.inlier[i] = fits ? 1 : 0;
    result.inliers += fits ? 1 : 0;
    result.cost += fits ? d * d : bound_px * bound_px;
  }
  return result;
}

std::array<PointMatch, kSample> draw(std::span<const PointMatch> matches, std::mt19937& rng) {
  std::array<PointMatch, kSample> drawn;
  const auto sample =
      draw_without_replacement<kSample>(rng, static_cast<std::uint32_t>(matches.size()));
  std::ranges::transform(sample, drawn.begin(), [&](std::uint32_t i) { return matches[i]; });
  return drawn;
}

std::vector<PointMatch> inliers_of(std::span<const PointMatch> matches,
                                   const Agreement& agreement) {
  std::vector<PointMatch> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (agreement.inlier[i] != 0) inliers.push_back(matches[i]);
  }
  return inliers;
}

}  // namespace

double epipolar_distance(const Eigen::Matrix3d& F, const PointMatch& match) {
  const Eigen::Vector3d line = F * match.previous_px.homogeneous();
  const double length = line.head<2>().norm();
  return length > 0 ? std::abs(line.dot(match.current_px.homogeneous())) / length : 0.0;
}

Eigen::Matrix3d fundamental_of_motion(const CameraModel& camera,
                                      const Eigen::Isometry3d& T_current_previous) {
  Eigen::Matrix3d K_inverse = Eigen::Matrix3d::Identity();
  K_inverse(0, 0) = 1 / camera.fx;
  K_inverse(1, 1) = 1 / camera.fy;
  K_inverse(0, 2) = -camera.cx / camera.fx;
  K_inverse(1, 2) = -camera.cy / camera.fy;
  return K_inverse.transpose() * skew(T_current_previous.translation()) *
         T_current_previous.linear() * K_inverse;
}

std::optional<Eigen::Matrix3d> eight_point(std::span<const PointMatch> matches) {
  if (matches.size() < kSample) return std::nullopt;
  const Normalizer previous = normalizer(matches, &PointMatch::previous_px);
  const Normalizer current = normalizer(matches, &PointMatch::current_px);
  Matrix9d normal = Matrix9d::Zero();
  for (const PointMatch& match : matches) {
    const Eigen::Vector3d p = previous(match.previous_px), c = current(match.current_px);
    Vector9d row;
    row << c.x() * p, c.y() * p, p;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(normal);
  const Vector9d f = solver.eigenvectors().col(0);
  Eigen::Matrix3d F;
  F << f.segment<3>(0).transpose(), f.segment<3>(3).transpose(), f.segment<3>(6).transpose();
  F = current.matrix().transpose() * rank_two(F) * previous.matrix();
  const double norm = F.norm();
  if (!(norm > 0) || !F.allFinite()) return std::nullopt;
  return Eigen::Matrix3d(F / norm);
}

std::optional<FundamentalEstimate> estimate_fundamental(std::span<const PointMatch> matches,
                                                        double bound_px,
                                                        int max_iterations,
                                                        std::mt19937& rng) {
  if (matches.size() < kSample) return std::nullopt;
  constexpr int kMinInliers = static_cast<int>(kSample);
  const auto agreement = [&](const Eigen::Matrix3d& F) {
    return agreement_with(F, matches, bound_px);
  };
  auto best = ransac(
      max_iterations,
      Agreement{},
      [&] { return eight_point(draw(matches, rng)); },
      agreement,
      [&](const Agreement& of) {
        return ransac_iterations(of.inliers, matches.size(), kSample, max_iterations);
      });
  for (int round = 0; round < 3 && best && best->support.inliers >= kMinInliers; ++round) {
    const std::optional<Eigen::Matrix3d> F = eight_point(inliers_of(matches, best->support));
    if (!F) break;
    Agreement refined = agreement(*F);
    if (!(best->support < refined)) break;
    best = {*F, std::move(refined)};
  }
  if (!best || best->support.inliers < kMinInliers) return std::nullopt;
  return FundamentalEstimate{best->model, std::move(best->support.inlier), best->support.inliers};
}

}  // namespace stillmap
