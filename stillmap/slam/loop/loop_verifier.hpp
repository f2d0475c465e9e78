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
    visit("iterations", self.iterations, FieldInfo{"of RANSAC, at most", "", 1, 100000});
    visit("min_matches",
          self.min_matches,
          FieldInfo{"by appearance that have one rigid motion in common", "", 4, 10000});
    visit("min_inliers", self.min_inliers, FieldInfo{"that prove a loop", "", 4, 10000});
    visit("min_share",
          self.min_share,
          FieldInfo{"of what one image should see of the other's points, found there", "", 0, 1});
    visit("max_sigma_m",
          self.max_sigma_m,
          FieldInfo{"error of the position that the matches leave, at most", "m", 0, 10});
    visit(
        "search_radius_px",
        self.search_radius_px,
        FieldInfo{
            "search for more matches once a motion is found, on the finest level", "px", 0.5, 100});
    visit.group("appearance_match", self.appearance_match);
    visit.group("search_match", self.search_match);
  }
};

/// Decides from geometry whether two images show one place, and how they stand to each other.
///
/// Matches by appearance that a rigid motion explains (RANSAC over three matches; a match agrees
/// when the point of each side falls, at its depth, where the other has its feature); the pose is
/// refined, the other matches are looked for where it says, and the pose is refined with them. A
/// loop needs enough of them, and a fair share of what the one image should see of the other: two
/// desks of one make have a desk in common but not what stands round it.
class LoopVerifier {
 public:
  /// `measure` should trust depths as far as the sensor earns it, with an inverse depth sigma of
  /// about 0.01: before a wall, pixels alone hardly tell a step aside from a turn.
  LoopVerifier(const LoopVerifierConfig& config,
               const CameraModel& camera,
               MeasurementModel measure,
               std::uint32_t seed);

  /// Nothing where the views are not of one place, as far as can be told. `frame`: a's, from which
  /// (with the seed) the random draws follow; the same input gives the same bits.
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
