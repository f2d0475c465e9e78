// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/camera_times.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <Eigen/LU>

#include "stillmap/slam/mapping/map_problem.hpp"
#include "stillmap/slam/optim/pose_time.hpp"

namespace stillmap {
namespace {

constexpr double kSignificant = 4;        // standard deviations
constexpr double kNegligible_s = 1e-3;    // 0.4 mm at 0.4 m/s
constexpr double kForgetting = 1.0 / 20;  // of earlier windows, per window: as many key frames as
                                          // a window has
constexpr std::size_t kLatestKeyframes = 40;  // bounds the cost
constexpr double kLeastCondition = 1e-12;     // of the information

// A velocity that is not known is zero.
bool moves(const CameraVelocity& velocity) {
  return velocity.linear.squaredNorm() + velocity.angular.squaredNorm() > 0;
}

bool differs(const CameraTimes& a, const CameraTimes& b) {
  return std::abs(a.readout_s - b.readout_s) > kNegligible_s ||
         std::abs(a.depth_delay_s - b.depth_delay_s) > kNegligible_s;
}

double believed(double estimate, double sigma, double stated) {
  const double least = std::max(kSignificant * sigma, kNegligible_s);
  return std::abs(estimate - stated) > least ? estimate : stated;
}

}  // namespace

TimeEvidence time_evidence_of(const Map& window,
                              std::span<const KeyframeId> core,
                              const CameraModel& camera,
                              const MeasurementModel& measure) {
  std::set<KeyframeId> asked(core.begin(), core.end());
  auto latest = window.keyframes().rbegin();
  for (std::size_t i = 0; i < kLatestKeyframes && latest != window.keyframes().rend(); ++i) {
    asked.insert((latest++)->first);
  }
  MapProblem made = make_problem(window, asked, camera, measure);
  TimedBundle bundle{std::move(made.problem), {}, {}};
  for (std::size_t c = 0; c < made.keyframes.size(); ++c) {
    const KeyframeId id = made.keyframes[c];
    bundle.timing.push_back(window.keyframe(id).timing);
    // Nothing depends on where the bundle stands: origins are as free as others.
    const bool takes_part = asked.contains(id) && moves(bundle.timing[c].smooth_velocity);
    bundle.problem.held[c] = takes_part ? 0 : 1;
  }
  for (std::size_t i = 0; i < made.features.size(); ++i) {
    const Keyframe& keyframe =
        window.keyframe(made.keyframes[bundle.problem.observations[i].camera]);
    bundle.row.push_back(row_position(keyframe.features->raw_px[made.features[i]], camera));
  }
  return time_evidence(bundle);
}

void correct_times(Map& window,
                   std::span<const KeyframeId> core,
                   const CameraModel& camera,
                   const CameraTimes& times) {
  for (const KeyframeId id : core) {
    const Keyframe& keyframe = window.keyframe(id);
    if (!moves(keyframe.timing.velocity) || !differs(keyframe.timing.assumed, times)) continue;
    FeatureTiming timing = keyframe.timing;
    timing.assumed = times;
    window.set_features(
        id,
        std::make_shared<const Features>(at_pose_time(*keyframe.features, camera, timing)),
        timing);
  }
}

CameraTimesEstimator::CameraTimesEstimator(const ShutterConfig& config, const CameraModel& camera)
    : config_(config),
      stated_{std::min(camera.readout_s, config.max_readout_s), 0},
      times_(stated_) {}

void CameraTimesEstimator::add(const TimeEvidence& window) {
  if (!config_.calibrate) return;
  sum_.information = (1 - kForgetting) * sum_.information + window.information;
  sum_.vector = (1 - kForgetting) * sum_.vector + window.vector;
  windows_ = (1 - kForgetting) * windows_ + 1;
  Eigen::Matrix2d covariance;
  bool invertible = false;
  sum_.information.computeInverseWithCheck(covariance, invertible, kLeastCondition);
  if (!invertible || !covariance.allFinite()) return;
  const Eigen::Vector2d estimate = covariance * sum_.vector;
  const Eigen::Vector2d sigma = (windows_ * covariance.diagonal()).cwiseMax(0).cwiseSqrt();
  times_.readout_s =
      std::clamp(believed(estimate(0), sigma(0), stated_.readout_s), 0.0, config_.max_readout_s);
  times_.depth_delay_s = std::clamp(believed(estimate(1), sigma(1), stated_.depth_delay_s),
                                    -config_.max_depth_delay_s,
                                    config_.max_depth_delay_s);
}

}  // namespace stillmap
