// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/loop/loop_match.hpp"
#include "stillmap/slam/loop/loop_view.hpp"

namespace stillmap {

struct LoopVerifierConfig {
  int iterations = 500;
  int min_matches = 15;
  int min_inliers = 40;
  double min_share = 0.2;
  double max_sigma_m = 0.1;
  double search_radius_px = 6;
  MatchRules appearance_match{.max_distance = 60, .max_ratio = 0.85};
  MatchRules search_match{.max_distance = 64};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("iterations",
          self.iterations,
          FieldInfo{"greatest number of RANSAC iterations", "", 1, 100000});
    visit("min_matches",
          self.min_matches,
          FieldInfo{
              "number of matches by appearance that must agree on one rigid motion", "", 4, 10000});
    visit("min_inliers",
          self.min_inliers,
          FieldInfo{"number of matches that confirm a loop", "", 4, 10000});
    visit("min_share",
          self.min_share,
          FieldInfo{"share of the other image's visible points that must be matched", "", 0, 1});
    visit("max_sigma_m",
          self.max_sigma_m,
          FieldInfo{"greatest standard deviation of the relative position", "m", 0, 10});
    visit(
        "search_radius_px",
        self.search_radius_px,
        FieldInfo{"search radius for further matches from the motion, at the finest pyramid level",
                  "px",
                  0.5,
                  100});
    visit.group("appearance_match", self.appearance_match);
    visit.group("search_match", self.search_match);
  }
};

/// Decides by geometry whether two images show one place, and estimates their relative pose.
///
/// Features are matched by appearance, and RANSAC over three matches finds the rigid motion that
/// most matches agree with: the point of each view projects, at its depth, to the feature of the
/// other. The pose is refined, further matches are searched from it, and it is refined with them. A
/// loop needs a number of matches, and a share of the points of one image that should be visible in
/// the other: two desks of one make have the desk in common, but not their surroundings.
class LoopVerifier {
 public:
  /// `measure` should give depth its full weight, with an inverse depth sigma of about 0.01: before
  /// a wall pixels alone hardly distinguish a step to the side from a turn.
  LoopVerifier(const LoopVerifierConfig& config,
               const CameraModel& camera,
               MeasurementModel measure,
               std::uint32_t seed);

  /// The match of two views; nothing unless they are confirmed to show one place. `frame` is the
  /// frame of a, which with the seed determines the random draws. The same input gives the same
  /// bits.
  [[nodiscard]] std::optional<LoopMatch> verify(FrameId frame,
                                                const LoopView& a,
                                                const LoopView& b) const;

 private:
  using Match = std::pair<std::uint32_t, std::uint32_t>;
  struct Spread {
    double sigma_m = std::numeric_limits<double>::infinity();
    double sigma_rad = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] std::vector<Match> match(const LoopView& a, const LoopView& b) const;
  [[nodiscard]] bool agrees(const LoopView& a,
                            const LoopView& b,
                            const Eigen::Isometry3d& T_a_b,
                            const Match& match) const;
  [[nodiscard]] std::vector<Match> agreeing(const LoopView& a,
                                            const LoopView& b,
                                            const Eigen::Isometry3d& T_a_b,
                                            std::span<const Match> matches) const;
  [[nodiscard]] std::optional<Eigen::Isometry3d> sample(FrameId frame,
                                                        const LoopView& a,
                                                        const LoopView& b,
                                                        std::span<const Match> matches) const;
  [[nodiscard]] Eigen::Isometry3d refine(const LoopView& a,
                                         const LoopView& b,
                                         const Eigen::Isometry3d& T_a_b,
                                         std::span<const Match> matches) const;
  [[nodiscard]] Spread spread(const LoopView& a,
                              const LoopView& b,
                              const Eigen::Isometry3d& T_a_b,
                              std::span<const Match> matches) const;
  [[nodiscard]] std::vector<Projection> project(const LoopView& b,
                                                const Eigen::Isometry3d& T_a_b) const;

  LoopVerifierConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  std::uint32_t seed_;
};

}  // namespace stillmap
