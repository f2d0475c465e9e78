// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/feature_filter.hpp"

#include <algorithm>

#include "stillmap/core/random.hpp"
#include "stillmap/perception/motion/consecutive_matches.hpp"
#include "stillmap/slam/features/feature_selection.hpp"

namespace stillmap {
namespace {

bool inside(const PixelBox& box, const Eigen::Vector2f& px) {
  const double x = static_cast<double>(px.x()), y = static_cast<double>(px.y());
  return x >= box.x0 && x <= box.x1 && y >= box.y0 && y <= box.y1;
}

/// Per feature, whether one of the boxes holds it.
std::vector<std::uint8_t> boxed_features(const FeatureScene& scene) {
  std::vector<std::uint8_t> boxed;
  boxed.reserve(scene.features.size());
  for (const Eigen::Vector2f& px : scene.features.raw_px) {
    const bool held = std::ranges::any_of(scene.dynamic_boxes,
                                          [&](const PixelBox& box) { return inside(box, px); });
    boxed.push_back(held ? 1 : 0);
  }
  return boxed;
}

PointMatch point_match(const Features& previous, const Features& current, const FeatureMatch& m) {
  return {previous.ideal_px[m.query].cast<double>(),
          current.ideal_px[m.feature].cast<double>(),
          static_cast<double>(previous.sensor_depth_m[m.query]),
          static_cast<double>(current.sensor_depth_m[m.feature])};
}

using MatchVerdicts = std::vector<std::optional<MatchVerdict>>;

/// The verdict on a feature in the box of a dynamic object. A feature without a match verdict, as
/// every new feature, is kept: when people fill the image nearly all features are in boxes, and
/// dropping them would lose tracking.
FeatureVerdict verdict_in_box(const std::optional<MatchVerdict>& match_verdict) {
  switch (match_verdict.value_or(MatchVerdict::kUnknown)) {
    case MatchVerdict::kStatic:
      return FeatureVerdict::kStaticInBox;
    case MatchVerdict::kDynamic:
      return FeatureVerdict::kDynamic;
    case MatchVerdict::kUnknown:
      break;
  }
  return FeatureVerdict::kStable;
}

}  // namespace

FeatureFilter::FeatureFilter(const FeatureFilterConfig& config,
                             const CameraModel& camera,
                             const DynamicsMode& mode,
                             std::uint32_t seed)
    : config_(config),
      camera_(camera),
      drops_missing_depth_(mode.depth_stability == DepthStabilityRule::kDrop),
      seed_(seed) {
  if (mode.depth_stability == DepthStabilityRule::kNone) config_.depth_stability.enabled = false;
  if (mode.depth_stability == DepthStabilityRule::kDrop) {
    config_.depth_stability.relative = false;
    config_.depth_stability.rejected = "drop";
  }
  const bool asked =
      mode.static_matches == StaticMatchRule::kJudge ||
      (mode.static_matches == StaticMatchRule::kConfigured && config_.static_matches.in_full);
  if (!asked) config_.static_matches.enabled = false;
}

FilteredFeatures FeatureFilter::filter(const FeatureScene& scene) const {
  const std::vector<FeatureVerdict> verdicts = judge(scene);
  FilteredFeatures filtered;
  std::vector<std::uint8_t> keep(verdicts.size(), 0);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (dropped(verdicts[i])) {
      filtered.dropped.push_back({scene.features.raw_px[i], verdicts[i]});
    } else {
      keep[i] = 1;
      filtered.verdicts.push_back(verdicts[i]);
    }
  }
  filtered.features = select_features(scene.features, keep, camera_);
  for (std::size_t i = 0; i < filtered.verdicts.size(); ++i) {
    if (!without_depth(filtered.verdicts[i])) continue;
    filtered.features.sensor_depth_m[i] = 0;
    filtered.features.depth_m[i] = 0;
  }
  return filtered;
}

std::vector<FeatureVerdict> FeatureFilter::judge(const FeatureScene& scene) const {
  std::vector<FeatureVerdict> verdicts(scene.features.size(), FeatureVerdict::kStable);
  if (config_.static_matches.enabled) {
    const std::vector<std::uint8_t> boxed = boxed_features(scene);
    const MatchVerdicts match_verdicts = judge_boxes(scene, boxed);
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      if (boxed[i] != 0) verdicts[i] = verdict_in_box(match_verdicts[i]);
    }
  }
  if (!config_.depth_stability.enabled) return verdicts;
  const std::vector<DepthStability> depths =
      judge_depth_stability(scene.depth, scene.features.raw_px, config_.depth_stability);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (verdicts[i] == FeatureVerdict::kDynamic) continue;
    if (depths[i] == DepthStability::kMissing) verdicts[i] = FeatureVerdict::kMissingDepth;
    if (depths[i] == DepthStability::kUnstable) verdicts[i] = FeatureVerdict::kUnstableDepth;
  }
  return verdicts;
}

std::vector<std::optional<MatchVerdict>> FeatureFilter::judge_boxes(
    const FeatureScene& scene, const std::vector<std::uint8_t>& boxed) const {
  std::vector<std::optional<MatchVerdict>> match_verdicts(scene.features.size());
  const bool any_boxed = std::ranges::find(boxed, std::uint8_t{1}) != boxed.end();
  if (scene.previous == nullptr || !any_boxed) return match_verdicts;
  const std::vector<FeatureMatch> matches = match_consecutive(*scene.previous,
                                                              scene.features,
                                                              camera_,
                                                              scene.T_current_previous,
                                                              config_.static_matches.search_px,
                                                              config_.static_matches.match);
  std::vector<PointMatch> environment;
  for (const FeatureMatch& match : matches) {
    if (boxed[match.feature] != 0) continue;
    environment.push_back(point_match(*scene.previous, scene.features, match));
  }
  std::mt19937 rng = rng_for(seed_, scene.frame, RandomPurpose::kEpipolarGeometry);
  const TwoViewGeometry geometry = estimate_two_view(
      camera_, environment, scene.T_current_previous, config_.static_matches, rng);
  for (const FeatureMatch& match : matches) {
    if (boxed[match.feature] == 0) continue;
    match_verdicts[match.feature] = judge_match(camera_,
                                                geometry,
                                                point_match(*scene.previous, scene.features, match),
                                                config_.static_matches);
  }
  return match_verdicts;
}

bool FeatureFilter::dropped(FeatureVerdict verdict) const {
  switch (verdict) {
    case FeatureVerdict::kDynamic:
      return true;
    case FeatureVerdict::kUnstableDepth:
      return config_.depth_stability.rejected == "drop";
    case FeatureVerdict::kMissingDepth:
      return drops_missing_depth_;
    case FeatureVerdict::kStable:
    case FeatureVerdict::kStaticInBox:
    case FeatureVerdict::kDoubted:
      break;
  }
  return false;
}

bool FeatureFilter::without_depth(FeatureVerdict verdict) const {
  return verdict == FeatureVerdict::kUnstableDepth &&
         config_.depth_stability.rejected == "depthless";
}

}  // namespace stillmap
