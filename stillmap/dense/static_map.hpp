// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/dense/free_space.hpp"
#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/dense/missed_movers.hpp"
#include "stillmap/dense/range_image.hpp"
#include "stillmap/dense/static_depth.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/dense/surface_fusion.hpp"
#include "stillmap/dense/view_selection.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"

namespace stillmap {

/// Settings of the dense map.
struct CloudConfig {
  double voxel_size_m = 0.01;
  StaticDepthConfig depth;
  std::string points = "by_mode";
  LocalCloudConfig local;
  std::string view_frames = "by_mode";
  int view_gap_frames = 4;
  ViewSelectionConfig views;
  FusionConfig fusion;
  std::string free_space = "by_mode";
  RangeImageConfig range;
  FreeSpaceConfig free;
  std::string missed_people = "by_mode";
  MissedMoversConfig missed;

  /// The settings with each "by_mode" replaced by the rule of a mode.
  [[nodiscard]] CloudConfig resolved_for(const CloudRules& rules) const;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("voxel_size_m",
          self.voxel_size_m,
          common_setting(
              FieldInfo{"edge of the voxels of the dense map, which keeps one point per voxel",
                        "m",
                        0.001,
                        1.0}));
    StaticDepthConfig::fields(self.depth, visit);
    visit("points",
          self.points,
          FieldInfo{"points of a view. pixels: one for each pixel; cells: means over cells of "
                    "pixels; by_mode: as dynamics.mode says",
                    "",
                    0,
                    0,
                    {"by_mode", "pixels", "cells"}});
    LocalCloudConfig::fields(self.local, visit);
    visit("view_frames",
          self.view_frames,
          FieldInfo{"frames that may become views. keyframes: all key frames and no others; all: "
                    "as view_gap_frames and views say; by_mode: as dynamics.mode says",
                    "",
                    0,
                    0,
                    {"by_mode", "keyframes", "all"}});
    visit("view_gap_frames",
          self.view_gap_frames,
          common_setting(FieldInfo{"number of frames after a view that make any frame a view; 0: "
                                   "only key frames are views",
                                   "frames",
                                   0,
                                   1000000}));
    visit.group("views", self.views);
    FusionConfig::fields(self.fusion, visit);
    visit("free_space",
          self.free_space,
          common_setting(FieldInfo{
              "removal of points that later views see through; by_mode: as dynamics.mode says",
              "",
              0,
              0,
              {"by_mode", "off", "on"}}));
    visit.group("range", self.range);
    visit.group("free", self.free);
    visit("missed_people",
          self.missed_people,
          FieldInfo{"removal of surface where a person that the network missed must have been; "
                    "by_mode: as dynamics.mode says",
                    "",
                    0,
                    0,
                    {"by_mode", "off", "on"}});
    visit.group("missed", self.missed);
  }
};

/// The dense map of views in the order of their time, in the world frame of their poses. `config`
/// must be resolved. The same bits with any number of threads.
[[nodiscard]] PointCloud static_map(std::span<const PosedView> views,
                                    const CameraModel& camera,
                                    const CloudConfig& config,
                                    std::size_t threads = 1);

/// The view of a frame: its static surface, without `dynamic_regions.excluded`. `labels` may be
/// empty. `config` must be resolved.
[[nodiscard]] StaticView static_view(const RgbdFrame& frame,
                                     const cv::Mat2f& rays,
                                     const CloudConfig& config,
                                     const DynamicRegions& dynamic_regions,
                                     const LabelImage& labels);

/// The dynamic regions of a frame, for its view. Excluded are all dynamic pixels and a margin.
/// Moving are the pixels of objects, and of depth jumps that cover a square with a side of 1/70 of
/// the image's width; noise does not cover such squares.
[[nodiscard]] DynamicRegions dynamic_regions(const DynamicMask& mask, const Mask& excluded);

}  // namespace stillmap
