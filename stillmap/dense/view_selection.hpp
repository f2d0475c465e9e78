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

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enough",
          self.enough,
          FieldInfo{"a surface is well known when so many views of the map show it; 0: every view "
                    "joins the map",
                    "",
                    0,
                    1000});
    visit("nearer",
          self.nearer,
          FieldInfo{"and are no farther from it than this many times the distance of the new one",
                    "",
                    1,
                    1000});
    visit("min_unknown_share",
          self.min_unknown_share,
          FieldInfo{
              "a view joins the map when more than this share of it is not well known", "", 0, 1});
    visit(
        "min_changed_share",
        self.min_changed_share,
        FieldInfo{
            "or more than this share is not as the map has it: something came or went", "", 0, 1});
  }
};

/// What a view would add to those held, as shares of what it shows.
struct ViewGain {
  double unknown = 0;  ///< not seen by enough of them from near enough
  double came = 0;     ///< stands where the last of them see through
  double went = 0;     ///< is seen through although the map made of them has it; not looked for
                       ///< where the others suffice for the view to join
};

/// Compares a sample of a view's points with the ranges of the views held, in the order of their
/// time, and a sample of their points with its range. Views without range tell nothing. Takes time
/// linear in the number of views.
[[nodiscard]] ViewGain gain_of(const PosedView& view,
                               std::span<const PosedView> held,
                               const CameraModel& camera,
                               const ViewSelectionConfig& config,
                               const FreeSpaceConfig& free_space);

/// Whether a view is to join those held.
[[nodiscard]] bool is_worth_keeping(const ViewGain& news, const ViewSelectionConfig& config);

}  // namespace stillmap
