// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dynamics/feature_fates.hpp"

#include <algorithm>

#include "stillmap/core/random.hpp"
#include "stillmap/dynamics/consecutive_matches.hpp"
#include "stillmap/features/feature_selection.hpp"

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

using Verdicts = std::vector<std::optional<MatchVerdict>>;

/// What is seen in a box of something dynamic. Without a verdict, as every new feature is, it
/// stays: where people fill the image nearly all features are in boxes, and to drop those would
/// lose the camera.
FeatureFate fate_in_box(const std::optional<MatchVerdict>& verdict) {
  switch (verdict.value_or(MatchVerdict::kUnknown)) {
    case MatchVerdict::kStatic:
      return FeatureFate::kStaticInBox;
    case MatchVerdict::kDynamic:
      return FeatureFate::kDynamic;
    case MatchVerdict::kUnknown:
      break;
  }
  return FeatureFate::kStable;
}

}  // namespace

FeatureSifter::FeatureSifter(const FeatureFatesConfig& config,
                             const CameraModel& camera,
                             DynamicsMode mode,
                             std::uint32_t seed)
    : config_(config), camera_(camera), mode_(mode), seed_(seed) {
  if (mode == DynamicsMode::kPaper) {
    config_.depth_stability.relative = false;
    config_.depth_stability.rejected = "drop";
  }
  if (mode == DynamicsMode::kFull && !config_.static_matches.in_full) {
    config_.static_matches.enabled = false;
  }
  if (mode == DynamicsMode::kMask) {
    config_.depth_stability.enabled = false;
    config_.static_matches.enabled = false;
  }
}

SiftedFeatures FeatureSifter::sift(const FeatureScene& scene) const {
  const std::vector<FeatureFate> fates = judge(scene);
  SiftedFeatures sifted;
  std::vector<std::uint8_t> keep(fates.size(), 0);
  for (std::size_t i = 0; i < fates.size(); ++i) {
    if (dropped(fates[i])) {
      sifted.dropped.push_back({scene.features.raw_px[i], fates[i]});
    } else {
      keep[i] = 1;
      sifted.fates.push_back(fates[i]);
    }
  }
  sifted.features = select_features(scene.features, keep, camera_);
  for (std::size_t i = 0; i < sifted.fates.size(); ++i) {
    if (!without_depth(sifted.fates[i])) continue;
    sifted.features.sensor_depth_m[i] = 0;
    sifted.features.depth_m[i] = 0;
  }
  return sifted;
}

std::vector<FeatureFate> FeatureSifter::judge(const FeatureScene& scene) const {
  std::vector<FeatureFate> fates(scene.features.size(), FeatureFate::kStable);
  if (config_.static_matches.enabled) {
    const std::vector<std::uint8_t> boxed = boxed_features(scene);
    const Verdicts verdicts = judge_boxes(scene, boxed);
    for (std::size_t i = 0; i < fates.size(); ++i) {
      if (boxed[i] != 0) fates[i] = fate_in_box(verdicts[i]);
    }
  }
  if (!config_.depth_stability.enabled) return fates;
  const std::vector<DepthStability> depths =
      judge_depth_stability(scene.depth, scene.features.raw_px, config_.depth_stability);
  for (std::size_t i = 0; i < fates.size(); ++i) {
    if (fates[i] == FeatureFate::kDynamic) continue;
    if (depths[i] == DepthStability::kMissing) fates[i] = FeatureFate::kMissingDepth;
    if (depths[i] == DepthStability::kUnstable) fates[i] = FeatureFate::kUnstableDepth;
  }
  return fates;
}

std::vector<std::optional<MatchVerdict>> FeatureSifter::judge_boxes(
    const FeatureScene& scene, const std::vector<std::uint8_t>& boxed) const {
  std::vector<std::optional<MatchVerdict>> verdicts(scene.features.size());
  const bool any_boxed = std::ranges::find(boxed, std::uint8_t{1}) != boxed.end();
  if (scene.previous == nullptr || !any_boxed) return verdicts;
  const std::vector<FeatureMatch> matches = match_consecutive(*scene.previous,
                                                              scene.features,
                                                              camera_,
                                                              scene.T_current_previous,
                                                              config_.static_matches.search_px);
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
    verdicts[match.feature] = judge_match(camera_,
                                          geometry,
                                          point_match(*scene.previous, scene.features, match),
                                          config_.static_matches);
  }
  return verdicts;
}

bool FeatureSifter::dropped(FeatureFate fate) const {
  switch (fate) {
    case FeatureFate::kDynamic:
      return true;
    case FeatureFate::kUnstableDepth:
      return config_.depth_stability.rejected == "drop";
    case FeatureFate::kMissingDepth:
      return mode_ == DynamicsMode::kPaper;
    case FeatureFate::kStable:
    case FeatureFate::kStaticInBox:
      break;
  }
  return false;
}

bool FeatureSifter::without_depth(FeatureFate fate) const {
  return fate == FeatureFate::kUnstableDepth && config_.depth_stability.rejected == "depthless";
}

}  // namespace stillmap
