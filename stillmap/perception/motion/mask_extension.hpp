// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

struct MaskExtensionConfig {
  bool enabled = true;
  bool bounded = true;
  std::string variant = "connected";
  double mad_factor = 3.0;
  int whole_box_px = 5000;
  double reach_m = 0.35;
  double interval_margin_m = 0.1;
  double box_margin = 0.15;
  double step_m = 0.01;
  double step_per_m = 0.003;
  int grow_px = 40;
  double min_mask_share = 0.4;
  bool drop_outliers = false;
  double large_part = 0.05;
  double static_m = 0.02;
  double static_per_m = 0.005;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled",
          self.enabled,
          FieldInfo{"whether the masks of dynamic objects are extended by depth"});
    visit("bounded",
          self.bounded,
          FieldInfo{"connected: whether an extended mask that is larger than objects of its class "
                    "are is replaced by the network's"});
    visit("variant",
          self.variant,
          FieldInfo{"rule of extension. paper: Fan 2020, Alg. 1; connected: pixels connected to "
                    "the mask in depth",
                    "",
                    0,
                    0,
                    {"paper", "connected"}});
    visit("mad_factor",
          self.mad_factor,
          FieldInfo{"distance from the median, in scaled MADs, beyond which a depth of the mask is "
                    "an outlier",
                    "",
                    0.1,
                    100});
    visit("whole_box_px",
          self.whole_box_px,
          FieldInfo{"paper: area below which a mask is replaced by its box (tau1 of Fan 2020)",
                    "pixels at 640x480",
                    0,
                    307200});
    connected_fields(self, visit);
  }

 private:
  template <class Self, class Visitor>
  static void connected_fields(Self& self, Visitor& visit) {
    visit("reach_m",
          self.reach_m,
          FieldInfo{"connected: distance from the median within which a depth is never an outlier",
                    "m",
                    0,
                    10});
    visit("interval_margin_m",
          self.interval_margin_m,
          FieldInfo{"connected: widening of the interval of the object's depths, at both ends",
                    "m",
                    0,
                    10});
    visit(
        "box_margin",
        self.box_margin,
        FieldInfo{"connected: widening of the box on each side, as a share of its size", "", 0, 2});
    visit(
        "step_m",
        self.step_m,
        FieldInfo{
            "connected: depth step between connected neighbours, in addition to noise", "m", 0, 1});
    visit("step_per_m",
          self.step_per_m,
          FieldInfo{"connected: growth of step_m with depth squared", "1/m", 0, 1});
    visit("grow_px",
          self.grow_px,
          FieldInfo{"connected: greatest distance of an added pixel from the mask",
                    "pixels at 640x480",
                    0,
                    1000});
    visit("min_mask_share",
          self.min_mask_share,
          FieldInfo{"connected: share of mask pixels below which a connected part adds no pixels",
                    "",
                    0,
                    1});
    visit("large_part",
          self.large_part,
          FieldInfo{
              "connected: share of the mask above which a part belongs to the object at any depth",
              "",
              0,
              1});
    visit("static_m",
          self.static_m,
          FieldInfo{"connected: distance from known static depth within which a pixel is not added",
                    "m",
                    0,
                    1});
    visit("static_per_m",
          self.static_per_m,
          FieldInfo{"connected: growth of static_m with depth squared", "1/m", 0, 1});
    visit("drop_outliers",
          self.drop_outliers,
          FieldInfo{"connected: whether mask pixels outside the object's depths are removed from "
                    "the mask"});
  }
};

/// The extended mask of an object (Fan 2020, section III-A, Alg. 1, Eqs. (2)-(5)).
///
/// `paper`: the mask, and the pixels of the box whose depth is strictly between the least and the
/// greatest depth of the mask without outliers; the whole box if the mask has fewer than
/// `whole_box_px` pixels.
///
/// `connected`: a chair or a wall at the depth of a limb does not join. Starting from the mask
/// pixels without outliers, neighbours join while the depth steps between them are small, their
/// depth is in the interval of the object's depths or they are in the mask, and they are near mask
/// and box. Parts with too small a share of mask pixels keep only these. Holes without depth inside
/// are filled. Depth is sampled in every second row and column. A mask without any depth stays
/// unchanged.
///
/// `known_static`, if not empty, is the depth of known static surface: pixels of that depth do not
/// join (`connected`).
///
/// `area` is the area of the object's id in `object.mask`, which has the size of `object.depth`.
/// The result may be empty.
[[nodiscard]] PixelPatch extend_mask(const ObjectView& object,
                                     const MaskArea& area,
                                     const ObjectDepths& depths,
                                     const MaskExtensionConfig& config,
                                     const HalfDepth& known_static = {});

/// The mask of an object without extension.
[[nodiscard]] PixelPatch mask_patch(const ObjectView& object, const MaskArea& area);

/// The rule for depth outliers of the variant of `config`.
[[nodiscard]] OutlierRule outlier_rule(const MaskExtensionConfig& config);

}  // namespace stillmap
