// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/range_image.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct FreeSpaceConfig {
  double cell_m = 0.02;
  double margin_m = 0.05;
  double margin_per_m = 0.0045;
  int min_through = 2;
  int min_stay = 5;
  double max_through_share = 0.25;
  double max_moving_share = 2.0;
  int weakly_seen = 4;
  double beside_share = 0.125;
  double beside_m = 0.3;
  double detached_m = 0.2;
  double max_detached_share = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cell_m",
          self.cell_m,
          FieldInfo{"edge of the cubes whose points are judged together", "m", 0.001, 1});
    visit(
        "margin_m",
        self.margin_m,
        FieldInfo{"distance behind a point at which a measured depth sees through it", "m", 0, 10});
    visit("margin_per_m",
          self.margin_per_m,
          FieldInfo{"growth of margin_m with depth squared", "1/m", 0, 1});
    visit("min_through",
          self.min_through,
          FieldInfo{"number of final views in a row seeing through a point that remove it if "
                    "max_through_share holds",
                    "",
                    1,
                    1000});
    visit(
        "min_stay",
        self.min_stay,
        FieldInfo{
            "number of views after the last one seeing through a point that keep it", "", 1, 255});
    visit("max_through_share",
          self.max_through_share,
          FieldInfo{
              "greatest ratio of views that see through a point to views that see it", "", 0, 10});
    visit("max_moving_share",
          self.max_moving_share,
          FieldInfo{"greatest ratio of views that see motion at a point to views that see it",
                    "",
                    0,
                    1000});
    doubt_fields(self, visit);
  }

 private:
  template <class Self, class Visitor>
  static void doubt_fields(Self& self, Visitor& visit) {
    visit("weakly_seen",
          self.weakly_seen,
          FieldInfo{"number of views up to which a point is removed when all that see it see "
                    "motion beside it",
                    "",
                    0,
                    255});
    visit(
        "beside_share",
        self.beside_share,
        FieldInfo{"greatest distance of that motion in the image, as a share of the image's width",
                  "",
                  0,
                  1});
    visit("beside_m",
          self.beside_m,
          FieldInfo{"greatest distance of that motion in depth", "m", 0, 10});
    visit("detached_m",
          self.detached_m,
          FieldInfo{"extent up to which a piece of the map that touches nothing else is removed "
                    "when motion is measured at it, or when it is a single cube; 0: none is",
                    "m",
                    0,
                    10});
    visit("max_detached_share",
          self.max_detached_share,
          FieldInfo{"greatest ratio of views that see motion at such a piece to views that see it",
                    "",
                    0,
                    1000});
  }
};

/// The range image of a view with the view's pose.
struct PosedRange {
  Eigen::Isometry3d T_world_camera;
  const RangeImage* range;  ///< not null; not owned
};

/// How views, in the order of their time, see a point. Counts saturate at 255.
struct Sightings {
  std::uint8_t seen = 0;    ///< views that measure the point
  std::uint8_t moving = 0;  ///< views that measure a moving object at the point
  /// views with a moving object beside the point; weakly seen points only
  std::uint8_t beside = 0;
  std::uint8_t through = 0;       ///< views that see through the point
  std::uint8_t seen_last = 0;     ///< views that measure it after the last one that sees through it
  std::uint8_t through_last = 0;  ///< views that see through it after the last one that measures it
};

/// The sightings of each point (world frame, metres). A view in which the point is out of the
/// image, hidden, or at an unknown range does not count. The same with any number of threads.
[[nodiscard]] std::vector<Sightings> sightings(std::span<const Eigen::Vector3f> points,
                                               std::span<const PosedRange> ranges,
                                               const CameraModel& camera,
                                               const FreeSpaceConfig& config,
                                               std::size_t threads = 1);

/// Whether a point belongs to the static world as it is at the end of the run.
[[nodiscard]] bool stays(const Sightings& s, const FreeSpaceConfig& config);

/// The map without the points that sightings remove: those of moved objects. All points of a cube
/// of edge `cell_m` share the decision for their mean. Small pieces that hang in the air then go
/// by without_detached_pieces(). The same with any number of threads.
[[nodiscard]] PointCloud without_moved(const PointCloud& map,
                                       std::span<const PosedRange> ranges,
                                       const CameraModel& camera,
                                       const FreeSpaceConfig& config,
                                       std::size_t threads = 1);

}  // namespace stillmap
