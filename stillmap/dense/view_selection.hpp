// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/core/fields.hpp"
#include "stillmap/dense/free_space.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct ViewSelectionConfig {
  int enough = 20;
  double nearer = 1.5;
  double min_unknown_share = 0.1;
  double min_changed_share = 0.01;
  int most = 100;
  double most_mb = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "enough",
        self.enough,
        FieldInfo{
            "number of views that make a surface well known; 0: every view is kept", "", 0, 1000});
    visit(
        "nearer",
        self.nearer,
        FieldInfo{"factor on the distance of the new view within which those views must have been",
                  "",
                  1,
                  1000});
    visit("min_unknown_share",
          self.min_unknown_share,
          FieldInfo{"share of surface not well known above which a view is kept", "", 0, 1});
    visit("min_changed_share",
          self.min_changed_share,
          FieldInfo{"share of surface that came or went above which a view is kept", "", 0, 1});
    visit(
        "most",
        self.most,
        FieldInfo{"number of views that see half of a view which is kept, above which it takes the "
                  "place of one of them",
                  "",
                  1,
                  100000});
    visit("most_mb",
          self.most_mb,
          FieldInfo{"memory of all views above which the one that is needed least goes; 0: as much "
                    "as they take",
                    "MB",
                    0,
                    1e6});
  }
};

/// The gain of a new view over the views held, as shares of the surface that it shows.
struct ViewGain {
  double unknown = 0;  ///< surface not seen by enough of them from near enough
  double came = 0;     ///< surface that the last of them see through
  double went = 0;  ///< map surface that the new view sees through; 0 if the others already suffice
                    ///< to keep the view
  /// The view held whose place the new one takes if it is kept: of those that see half of its
  /// surface from about as far, the one that shows the least which few others show. Null while few
  /// views see half of that surface. So the views of a place that is seen again and again do not
  /// grow in number, however little of it is new each time.
  const StaticView* replaces = nullptr;
};

/// Compares a sample of the view's points with the range images of the views held, in the order of
/// their time, and a sample of their points with its range image. Views without range images are
/// ignored. Takes time linear in the number of views.
[[nodiscard]] ViewGain gain_of(const PosedView& view,
                               std::span<const PosedView> held,
                               const CameraModel& camera,
                               const ViewSelectionConfig& config,
                               const FreeSpaceConfig& free_space);

/// The view held that shows the least which few others show, `newest` included; the earliest of
/// equals. Null if none is held. Takes time in the square of their number.
[[nodiscard]] const StaticView* least_needed(std::span<const PosedView> held,
                                             const PosedView& newest,
                                             const CameraModel& camera,
                                             const ViewSelectionConfig& config,
                                             const FreeSpaceConfig& free_space);

/// Whether a view with this gain is kept.
[[nodiscard]] bool is_worth_keeping(const ViewGain& news, const ViewSelectionConfig& config);

}  // namespace stillmap
