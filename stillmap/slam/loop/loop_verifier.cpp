// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_verifier.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/random.hpp"
#include "stillmap/geometry/ransac.hpp"
#include "stillmap/geometry/rigid_alignment.hpp"
#include "stillmap/slam/map/landmark_projection.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"
#include "stillmap/slam/optim/symmetric_solver.hpp"
#include "stillmap/slam/optim/three_points.hpp"

namespace stillmap {

LoopVerifier::LoopVerifier(const LoopVerifierConfig& config,
                           const CameraModel& camera,
                           MeasurementModel measure,
                           std::uint32_t seed)
    : config_(config), camera_(camera), measure_(std::move(measure)), seed_(seed) {}

std::vector<LoopVerifier::Match> LoopVerifier::match(const LoopView& a, const LoopView& b) const {
  std::vector<std::uint32_t> with_point;
  for (std::uint32_t i = 0; i < b.p_camera.size(); ++i) {
    if (b.p_camera[i]) with_point.push_back(i);
  }
  const std::vector<FeatureMatch> by_appearance =
      match_all(*b.features, with_point, *a.features, config_.appearance_match);
  std::vector<Match> matches;
  for (const FeatureMatch& m :
       keep_consistent_rotations(by_appearance, b.features->angle_deg, a.features->angle_deg)) {
    if (a.p_camera[m.feature]) matches.emplace_back(m.feature, m.query);
  }
  return matches;
}

// The point of each side falls where the other has the feature.
bool LoopVerifier::agrees(const LoopView& a,
                          const LoopView& b,
                          const Eigen::Isometry3d& T_a_b,
                          const Match& match) const {
  const auto& [in_a, in_b] = match;
  if (!near_measurement(camera_, measure_(*a.features, in_a), T_a_b * *b.p_camera[in_b])) {
    return false;
  }
  return !a.p_camera[in_a] ||
         near_measurement(
             camera_, measure_(*b.features, in_b), T_a_b.inverse() * *a.p_camera[in_a]);
}

std::vector<LoopVerifier::Match> LoopVerifier::agreeing(const LoopView& a,
                                                        const LoopView& b,
                                                        const Eigen::Isometry3d& T_a_b,
                                                        std::span<const Match> matches) const {
  std::vector<Match> kept;
  std::ranges::copy_if(
      matches, std::back_inserter(kept), [&](const Match& m) { return agrees(a, b, T_a_b, m); });
  return kept;
}

// The motion of three matches that most matches agree with; nothing where too few do.
std::optional<Eigen::Isometry3d> LoopVerifier::sample(FrameId frame,
                                                      const LoopView& a,
                                                      const LoopView& b,
                                                      std::span<const Match> matches) const {
  const auto count = static_cast<std::uint32_t>(matches.size());
  std::mt19937 rng = rng_for(seed_, frame, RandomPurpose::kLoop);
  const auto motion_of_three = [&]() -> std::optional<Eigen::Isometry3d> {
    const Sample<3> sample = draw_with_replacement<3>(rng, count);
    PointTriple in_a, in_b;
    for (std::size_t i = 0; i < 3; ++i) {
      const Match& pick = matches[sample[i]];
      in_a[i] = *a.p_camera[pick.first];
      in_b[i] = *b.p_camera[pick.second];
    }
    if (!same_shape(in_a, in_b)) return std::nullopt;
    return align_rigid(in_b, in_a);
  };
  const auto best =
      ransac(config_.iterations,
             static_cast<std::size_t>(config_.min_matches - 1),
             motion_of_three,
             [&](const Eigen::Isometry3d& T_a_b) { return agreeing(a, b, T_a_b, matches).size(); });
  return best ? std::optional(best->model) : std::nullopt;
}

// Half way between what a sees of b's points and what b sees of a's.
Eigen::Isometry3d LoopVerifier::refine(const LoopView& a,
                                       const LoopView& b,
                                       const Eigen::Isometry3d& T_a_b,
                                       std::span<const Match> matches) const {
  std::vector<PoseObservation> by_a, by_b;
  for (const auto& [in_a, in_b] : matches) {
    by_a.push_back({*b.p_camera[in_b], measure_(*a.features, in_a)});
    if (a.p_camera[in_a]) by_b.push_back({*a.p_camera[in_a], measure_(*b.features, in_b)});
  }
  const Eigen::Isometry3d of_a = optimize_pose(camera_, T_a_b, by_a).T_camera_world;
  const Eigen::Isometry3d of_b = optimize_pose(camera_, T_a_b.inverse(), by_b).T_camera_world;
  return interpolate(of_a, of_b.inverse(), 0.5);
}

// How well the matches fix the pose, from the curvature of the errors in a's image.
LoopVerifier::Spread LoopVerifier::spread(const LoopView& a,
                                          const LoopView& b,
                                          const Eigen::Isometry3d& T_a_b,
                                          std::span<const Match> matches) const {
  Matrix6d H = Matrix6d::Zero();
  for (const auto& [in_a, in_b] : matches) {
    const Eigen::Vector3d p_a = T_a_b * *b.p_camera[in_b];
    const PointMeasurement m = measure_(*a.features, in_a);
    const Eigen::Matrix<double, 3, 6> J =
        pose_jacobian(reprojection_jacobian(camera_, m, p_a), p_a);
    H.noalias() += J.transpose() * J;
  }
  const std::optional<Matrix6d> covariance = inverse_of_symmetric(H, 1e-12);
  if (!covariance) return {};
  return {std::sqrt(covariance->topLeftCorner<3, 3>().trace()),
          std::sqrt(covariance->bottomRightCorner<3, 3>().trace())};
}

// Where a should see b's points; the descriptor is null for those that it should not see.
std::vector<Projection> LoopVerifier::project(const LoopView& b,
                                              const Eigen::Isometry3d& T_a_b) const {
  const std::vector<float>& scales = measure_.level_scales();
  std::vector<Projection> projections(b.p_camera.size());
  for (std::size_t i = 0; i < b.p_camera.size(); ++i) {
    if (!b.p_camera[i]) continue;
    const Eigen::Vector3d p_a = T_a_b * *b.p_camera[i];
    if (!in_view(camera_, p_a)) continue;
    // A corner looks larger from nearer by.
    const double ratio = b.p_camera[i]->norm() / p_a.norm();
    const double scale = static_cast<double>(scales[b.features->level[i]]) * ratio;
    const auto above = std::ranges::lower_bound(scales, static_cast<float>(0.95 * scale));
    const int level =
        static_cast<int>(std::min<std::ptrdiff_t>(above - scales.begin(), std::ssize(scales) - 1));
    if (scale < 0.8 || scale > 1.25 * static_cast<double>(scales.back())) continue;
    Projection& projection = projections[i];
    projection.px = camera_.project(p_a).cast<float>();
    projection.radius_px =
        static_cast<float>(config_.search_radius_px) * scales[static_cast<std::size_t>(level)];
    projection.inverse_depth = static_cast<float>(1.0 / p_a.z());
    projection.max_inverse_depth_error = inverse_depth_gate(1.0 / p_a.z());
    projection.min_level = level - 1;
    projection.max_level = level + 1;
    projection.descriptor = &b.features->descriptors[i];
  }
  return projections;
}

std::optional<LoopMatch> LoopVerifier::verify(FrameId frame,
                                              const LoopView& a,
                                              const LoopView& b) const {
  const std::vector<Match> by_appearance = match(a, b);
  if (by_appearance.size() < static_cast<std::size_t>(config_.min_matches)) return std::nullopt;
  const std::optional<Eigen::Isometry3d> sampled = sample(frame, a, b, by_appearance);
  if (!sampled) return std::nullopt;
  LoopMatch loop;
  loop.edge.a = a.keyframe;
  loop.edge.b = b.keyframe;
  Eigen::Isometry3d& T_a_b = loop.edge.T_a_b;
  T_a_b = refine(a, b, *sampled, agreeing(a, b, *sampled, by_appearance));

  // Twice, for the first pose may come from one corner of the image.
  for (int round = 0; round < 2; ++round) {
    std::vector<std::uint32_t> seen;  // features of b, as the projections
    std::vector<Projection> projections;
    const std::vector<Projection> all = project(b, T_a_b);
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      if (all[i].descriptor == nullptr) continue;
      seen.push_back(i);
      projections.push_back(all[i]);
    }
    std::vector<Match> guided;
    for (const FeatureMatch& m :
         match_projections(projections, *a.features, {}, config_.search_match)) {
      guided.emplace_back(m.feature, seen[m.query]);
    }
    T_a_b = refine(a, b, T_a_b, agreeing(a, b, T_a_b, guided));
    loop.matches = agreeing(a, b, T_a_b, guided);
    loop.expected = static_cast<int>(seen.size());
  }
  if (loop.matches.size() < static_cast<std::size_t>(config_.min_inliers)) return std::nullopt;
  if (loop.share() < config_.min_share) return std::nullopt;
  const Spread known = spread(a, b, T_a_b, loop.matches);
  loop.edge.sigma_m = known.sigma_m;
  loop.edge.sigma_rad = known.sigma_rad;
  if (!(known.sigma_m <= config_.max_sigma_m)) return std::nullopt;
  return loop;
}

}  // namespace stillmap
