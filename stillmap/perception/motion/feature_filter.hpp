// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

/// The features of a frame, with the input for judging them.
struct FeatureScene {
  const Features& features;
  const DepthImage& depth;
  std::vector<PixelBox> dynamic_boxes;
  FeaturesPtr previous;  ///< extracted features of the previous frame; may be null
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

/// Judges features by their depth (Fan 2020, section III-E) and, in the boxes of dynamic objects,
/// by their motion (section III-F), according to the rules of the mode. A feature in a box without
/// a match in the previous frame is kept. Keeps no state between frames; the same input and seed
/// give the same bits.
class FeatureFilter {
 public:
  FeatureFilter(const FeatureFilterConfig& config,
                const CameraModel& camera,
                const DynamicsMode& mode,
                std::uint32_t seed);

  [[nodiscard]] FilteredFeatures filter(const FeatureScene& scene) const;

 private:
  [[nodiscard]] std::vector<FeatureVerdict> judge(const FeatureScene& scene) const;
  [[nodiscard]] std::vector<std::optional<MatchVerdict>> judge_boxes(
      const FeatureScene& scene, const std::vector<std::uint8_t>& boxed) const;
  [[nodiscard]] bool dropped(FeatureVerdict verdict) const;
  [[nodiscard]] bool without_depth(FeatureVerdict verdict) const;

  FeatureFilterConfig config_;
  CameraModel camera_;
  bool drops_missing_depth_;
  std::uint32_t seed_;
};

}  // namespace stillmap
