// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/dense/depth_edges.hpp"

namespace stillmap {

struct StaticDepthConfig {
  double max_depth_m = 6.0;
  std::string edges = "by_mode";
  DepthEdgesConfig edge;
  std::string islands = "by_mode";
  double min_island_share = 1000.0 / (640 * 480);

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_depth_m",
          self.max_depth_m,
          common_setting(FieldInfo{"greatest depth that goes into the dense map", "m", 0.1, 1000}));
    visit(
        "edges",
        self.edges,
        FieldInfo{"removal of depth edges. fixed: by edge.step_m, missing depth being 0; growing: "
                  "with depth, too, missing depth being no edge; by_mode: as dynamics.mode says",
                  "",
                  0,
                  0,
                  {"by_mode", "off", "fixed", "growing"}});
    visit.group("edge", self.edge);
    visit("islands",
          self.islands,
          FieldInfo{"removal of small patches of depth; by_mode: as dynamics.mode says",
                    "",
                    0,
                    0,
                    {"by_mode", "off", "on"}});
    visit("min_island_share",
          self.min_island_share,
          FieldInfo{
              "share of the image below which a patch is removed (tau4 of Fan 2020)", "", 0, 1});
  }
};

/// The depth (metres) of static surface near enough for the map; 0 elsewhere. Removes, in this
/// order: pixels that are set in `dynamic` (of the same size, or empty) or have no depth (not over
/// 0, not finite), edges (without_fixed_edges() or without_edges()), islands (without_islands()),
/// and depth beyond `max_depth_m`. "by_mode" counts as "off".
[[nodiscard]] cv::Mat1f static_depth(const cv::Mat1f& depth,
                                     const Mask& dynamic,
                                     const StaticDepthConfig& config);

}  // namespace stillmap
