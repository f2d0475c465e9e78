// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/global_cloud.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct SurfaceFusionConfig {
  int rounds = 2;
  double cube_voxels = 4;
  double sigma_m = 0.001;
  double sigma_per_m = 0.0015;
  double gate_m = 0.01;
  double gate_sigmas = 3;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rounds",
          self.rounds,
          FieldInfo{"number of times that points move to the mean of the surfaces that the views "
                    "measure near them",
                    "",
                    0,
                    100});
    visit("cube_voxels",
          self.cube_voxels,
          FieldInfo{"edge of the cubes, in voxels, whose points move to one plane in all rounds "
                    "but the last",
                    "",
                    1,
                    100});
    visit("sigma_m",
          self.sigma_m,
          FieldInfo{
              "standard deviation of measured depth: sigma_m + sigma_per_m depth^2", "m", 1e-6, 1});
    visit("sigma_per_m",
          self.sigma_per_m,
          FieldInfo{"growth of the deviation with depth squared", "1/m", 0, 1});
    visit("gate_m",
          self.gate_m,
          FieldInfo{"distance within which a measured surface is that of a point: gate_m + "
                    "gate_sigmas deviations",
                    "m",
                    0,
                    1});
    visit("gate_sigmas",
          self.gate_sigmas,
          FieldInfo{"number of deviations in the distance of gate_m", "", 0, 100});
  }
};

/// How views become one cloud.
struct FusionConfig {
  std::string rule = "by_mode";
  SurfaceFusionConfig surface;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "fusion",
        self.rule,
        FieldInfo{"fusion of views. stitch: the mean of the points in each voxel; surface: points "
                  "on the surface that all views together measure; by_mode: as dynamics.mode "
                  "says",
                  "",
                  0,
                  0,
                  {"by_mode", "stitch", "surface"}});
    visit.group("surface", self.surface);
  }
};

/// The points of views on the surface that all views together measure, one per voxel, with normals
/// towards the cameras.
///
/// The means of small cubes are looked up first, and the points of a cube flattened to the plane
/// found there, so that far fewer voxels are left; then each voxel's point is looked up.
///
/// Each is looked up in every view. Where a view measures surface near it, the view asks it
/// to move along its ray to that surface. The point moves by the mean of all, weighted by the
/// inverse variance of the measurement: noise grows with depth squared, and with the slope of the
/// surface. So the points of many noisy views come to lie on one surface, as the zero of a
/// truncated signed distance (Curless and Levoy 1996) would, but no volume is kept: views stay in
/// their cameras' coordinates, and a corrected pose costs nothing.
///
/// `views` have their world poses; their clouds consist of cells of `cell_px` pixels. The same bits
/// with any number of threads.
[[nodiscard]] PointCloud fused_surface(std::span<const PosedCloud> views,
                                       const CameraModel& camera,
                                       int cell_px,
                                       double voxel_size_m,
                                       const SurfaceFusionConfig& config,
                                       std::size_t threads = 1);

}  // namespace stillmap
