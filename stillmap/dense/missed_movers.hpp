// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/fields.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/perception/objects/object_identities.hpp"

namespace stillmap {

struct MissedMoversConfig {
  double within_s = 1.0;
  double reach_m = 0.3;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("within_s",
          self.within_s,
          FieldInfo{"time before and after a person is seen in which the person is taken to be "
                    "there unseen; 0: never",
                    "s",
                    0,
                    10});
    visit(
        "reach_m",
        self.reach_m,
        FieldInfo{
            "distance from such a person within which a view shows no static surface", "m", 0, 10});
  }
};

/// Knows where people were in frames in which the network missed them: somebody who is seen in a
/// frame was near that place shortly before and after, though only a shoulder was in the image.
class MissedMovers {
 public:
  explicit MissedMovers(const MissedMoversConfig& config) : config_(config) {}

  /// Remembers the movers of a frame for the next frames.
  void remember(double stamp_s, std::vector<MoverSighting> movers);

  /// Points on the surface, as last or next seen and moved on by its velocity, of the movers that
  /// are not in the frame of that time; in the odometry frame. Movers seen in only one or two
  /// frames do not count.
  [[nodiscard]] std::vector<Eigen::Vector3d> places_at(double stamp_s) const;

 private:
  struct Frame {
    double stamp_s;
    std::vector<MoverSighting> movers;
  };
  /// A mover at one time; its middle moves at `velocity_m_s`.
  struct Place {
    double stamp_s;
    const std::vector<Eigen::Vector3d>* surface;
    Eigen::Vector3d velocity_m_s;
  };
  [[nodiscard]] std::vector<Place> track_of(TrackId track) const;

  MissedMoversConfig config_;
  std::deque<Frame> frames_;
};

/// The view without its points within `reach_m` of any of `places`, which are in its camera's
/// coordinates.
[[nodiscard]] StaticView without_places(const StaticView& view,
                                        std::span<const Eigen::Vector3d> places,
                                        double reach_m);

}  // namespace stillmap
