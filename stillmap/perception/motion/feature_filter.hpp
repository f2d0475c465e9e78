// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/status.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/motion/depth_stability.hpp"
#include "stillmap/perception/motion/modes.hpp"
#include "stillmap/perception/motion/static_matches.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

struct RejectedFeature {
  Eigen::Vector2f raw_px;
  FeatureVerdict verdict = FeatureVerdict::kStable;
};

/// The features that may be used for the pose, and the verdicts on all features.
struct FilteredFeatures {
  Features features;
  std::vector<FeatureVerdict> verdicts;  ///< of `features`; empty if the mode judges none
  std::vector<RejectedFeature> dropped;  ///< the features that were dropped
  FeaturesPtr matchable;  ///< those to be matched with the next frame's; null if none are matched
  MatchJudge judge = MatchJudge::kNotAsked;  ///< what matches in boxes were judged by
};

/// The features of a frame, with the input for judging them.
struct FeatureScene {
  const Features& features;
  const DepthImage& depth;
  std::vector<PixelBox> dynamic_boxes;
  ObjectMask masks;      ///< of dynamic objects, if features may be on them; else empty
  FeaturesPtr previous;  ///< matchable features of the previous frame; may be null
  std::optional<Eigen::Isometry3d> T_current_previous;  ///< predicted
  FrameId frame;
};

struct FeatureFilterConfig {
  DepthStabilityConfig depth_stability;
  StaticMatchesConfig static_matches;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.group("depth_stability", self.depth_stability);
    visit.group("static_matches", self.static_matches);
  }
};

/// Judges features by their depth (Fan 2020, section III-E); then those of stable depth, in the
/// boxes of dynamic objects, by their motion since the previous frame (section III-F); and drops
/// those on masks. The rules of the mode say which of this is done. Keeps no state between frames;
/// the same input and seed give the same bits.
class FeatureFilter {
 public:
  FeatureFilter(const FeatureFilterConfig& config,
                const CameraModel& camera,
                const DynamicsMode& mode,
                std::uint32_t seed);

  [[nodiscard]] FilteredFeatures filter(const FeatureScene& scene) const;

 private:
  /// Features of stable depth.
  struct Matchable {
    FeaturesPtr features;
    std::vector<std::size_t> place;  // of each among all features of the frame
  };
  struct JudgedMatches {
    std::vector<MatchVerdict> verdicts;  // of all features; kUnknown without a match in a box
    MatchJudge judge = MatchJudge::kNotAsked;
  };
  [[nodiscard]] std::vector<FeatureVerdict> judge_depths(const FeatureScene& scene) const;
  [[nodiscard]] Matchable matchable(const Features& features,
                                    const std::vector<FeatureVerdict>& by_depth) const;
  [[nodiscard]] JudgedMatches judge_matches(const FeatureScene& scene,
                                            const Matchable& current,
                                            const std::vector<std::uint8_t>& boxed) const;
  [[nodiscard]] FeatureVerdict verdict_in_box(MatchVerdict match_verdict) const;
  [[nodiscard]] std::array<bool, 256> moving_masks(const FeatureScene& scene,
                                                   const JudgedMatches& judged) const;
  [[nodiscard]] bool dropped(FeatureVerdict verdict) const;
  [[nodiscard]] bool without_depth(FeatureVerdict verdict) const;

  FeatureFilterConfig config_;
  CameraModel camera_;
  StaticMatchRule rule_;
  bool drops_missing_depth_;
  std::uint32_t seed_;
};

}  // namespace stillmap
