// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/feature_filter.hpp"

#include <algorithm>
#include <memory>

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

/// The id of the mask at a pixel; 0 for none.
std::uint8_t mask_at(const ObjectMask& masks, const Eigen::Vector2f& raw_px) {
  if (masks.mat.empty()) return 0;
  const Eigen::Vector2i px = raw_px.array().round().cast<int>();
  return masks.mat(px.y(), px.x());
}

}  // namespace

FeatureFilter::FeatureFilter(const FeatureFilterConfig& config,
                             const CameraModel& camera,
                             const DynamicsMode& mode,
                             std::uint32_t seed)
    : config_(config),
      camera_(camera),
      rule_(mode.static_matches),
      drops_missing_depth_(mode.depth_stability == DepthStabilityRule::kDrop),
      seed_(seed) {
  const bool judges_depths =
      mode.depth_stability == DepthStabilityRule::kDrop ||
      (mode.depth_stability == DepthStabilityRule::kConfigured && config_.depth_stability.in_full);
  if (!judges_depths) config_.depth_stability.enabled = false;
  if (mode.depth_stability == DepthStabilityRule::kDrop) {
    config_.depth_stability.relative = false;
    config_.depth_stability.rejected = "drop";
  }
  const bool asked =
      mode.static_matches == StaticMatchRule::kJudge ||
      mode.static_matches == StaticMatchRule::kObjects ||
      (mode.static_matches == StaticMatchRule::kConfigured && config_.static_matches.in_full);
  if (!asked) config_.static_matches.enabled = false;
  if (mode.static_matches == StaticMatchRule::kObjects) {
    config_.static_matches.epipolar_px = config_.static_matches.inlier_px;
  }
}

FilteredFeatures FeatureFilter::filter(const FeatureScene& scene) const {
  FilteredFeatures filtered;
  std::vector<FeatureVerdict> verdicts = judge_depths(scene);
  std::array<bool, 256> moving;
  moving.fill(true);
  if (config_.static_matches.enabled) {
    const Matchable current = matchable(scene.features, verdicts);
    filtered.matchable = current.features;
    const std::vector<std::uint8_t> boxed = boxed_features(scene);
    const JudgedMatches judged = judge_matches(scene, current, boxed);
    filtered.judge = judged.judge;
    if (rule_ == StaticMatchRule::kObjects) moving = moving_masks(scene, judged);
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      const bool asked = rule_ != StaticMatchRule::kObjects && boxed[i] != 0 &&
                         verdicts[i] == FeatureVerdict::kStable;
      if (asked) verdicts[i] = verdict_in_box(judged.verdicts[i]);
    }
  }
  std::vector<std::uint8_t> keep(verdicts.size(), 0);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const Eigen::Vector2f& px = scene.features.raw_px[i];
    const std::uint8_t id = mask_at(scene.masks, px);
    if (id != 0 && moving[id]) verdicts[i] = FeatureVerdict::kDynamic;
    if (dropped(verdicts[i])) {
      filtered.dropped.push_back({px, verdicts[i]});
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

std::vector<FeatureVerdict> FeatureFilter::judge_depths(const FeatureScene& scene) const {
  std::vector<FeatureVerdict> verdicts(scene.features.size(), FeatureVerdict::kStable);
  if (!config_.depth_stability.enabled) return verdicts;
  const std::vector<DepthStability> depths =
      judge_depth_stability(scene.depth, scene.features.raw_px, config_.depth_stability);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (depths[i] == DepthStability::kMissing) verdicts[i] = FeatureVerdict::kMissingDepth;
    if (depths[i] == DepthStability::kUnstable) verdicts[i] = FeatureVerdict::kUnstableDepth;
  }
  return verdicts;
}

FeatureFilter::Matchable FeatureFilter::matchable(
    const Features& features, const std::vector<FeatureVerdict>& by_depth) const {
  Matchable stable;
  std::vector<std::uint8_t> keep(by_depth.size(), 0);
  for (std::size_t i = 0; i < by_depth.size(); ++i) {
    if (by_depth[i] != FeatureVerdict::kStable) continue;
    keep[i] = 1;
    stable.place.push_back(i);
  }
  stable.features = std::make_shared<const Features>(select_features(features, keep, camera_));
  return stable;
}

FeatureFilter::JudgedMatches FeatureFilter::judge_matches(
    const FeatureScene& scene,
    const Matchable& current,
    const std::vector<std::uint8_t>& boxed) const {
  JudgedMatches judged{std::vector<MatchVerdict>(boxed.size(), MatchVerdict::kUnknown), {}};
  if (std::ranges::find(boxed, std::uint8_t{1}) == boxed.end()) return judged;
  judged.judge = MatchJudge::kNothing;
  if (scene.previous == nullptr) return judged;
  const std::vector<FeatureMatch> matches = match_consecutive(*scene.previous,
                                                              *current.features,
                                                              camera_,
                                                              scene.T_current_previous,
                                                              config_.static_matches.search_px,
                                                              config_.static_matches.match);
  std::vector<PointMatch> environment;
  for (const FeatureMatch& match : matches) {
    if (boxed[current.place[match.feature]] != 0) continue;
    environment.push_back(point_match(*scene.previous, *current.features, match));
  }
  std::mt19937 rng = rng_for(seed_, scene.frame, RandomPurpose::kEpipolarGeometry);
  const TwoViewGeometry geometry = estimate_two_view(
      camera_, environment, scene.T_current_previous, config_.static_matches, rng);
  judged.judge = geometry.judge;
  for (const FeatureMatch& match : matches) {
    const std::size_t i = current.place[match.feature];
    if (boxed[i] == 0) continue;
    judged.verdicts[i] = judge_match(camera_,
                                     geometry,
                                     point_match(*scene.previous, *current.features, match),
                                     config_.static_matches);
  }
  return judged;
}

// Yu 2018, section III-C. An object without judged matches counts as moving.
std::array<bool, 256> FeatureFilter::moving_masks(const FeatureScene& scene,
                                                  const JudgedMatches& judged) const {
  std::array<int, 256> moved{}, still{};
  for (std::size_t i = 0; i < judged.verdicts.size(); ++i) {
    const std::uint8_t id = mask_at(scene.masks, scene.features.raw_px[i]);
    if (judged.verdicts[i] == MatchVerdict::kDynamic) ++moved[id];
    if (judged.verdicts[i] == MatchVerdict::kStatic) ++still[id];
  }
  std::array<bool, 256> moving{};
  for (std::size_t id = 0; id < moving.size(); ++id) {
    const double matches = moved[id] + still[id];
    moving[id] = moved[id] >= config_.static_matches.moving_share * matches;
  }
  return moving;
}

FeatureVerdict FeatureFilter::verdict_in_box(MatchVerdict match_verdict) const {
  switch (match_verdict) {
    case MatchVerdict::kStatic:
      return FeatureVerdict::kStaticInBox;
    case MatchVerdict::kDynamic:
      return FeatureVerdict::kDynamic;
    case MatchVerdict::kUnknown:
      break;
  }
  return config_.static_matches.unmatched == "drop" ? FeatureVerdict::kDynamic
                                                    : FeatureVerdict::kStable;
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
