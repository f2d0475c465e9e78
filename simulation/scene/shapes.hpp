// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// The covering of a face of a shape.
struct Surface {
  MaterialId material = 0;
  double tile_m = 0;  ///< > 0: the picture repeats each so many metres; 0: it covers the face once
};

/// The faces of a box in the order +x, -x, +y, -y, +z, -z. As seen from outside, pictures stand
/// upright on the sides; on top and bottom their upper edge is the one towards +x.
using BoxSurfaces = std::array<Surface, 6>;

[[nodiscard]] BoxSurfaces all_faces(const Surface& surface);

/// The rounding of the edges of a box.
struct Rounding {
  double radius = 0;   ///< metres, at most half of the box's shortest side
  int edge_steps = 1;  ///< 1: a bevel
  int flat_steps = 1;  ///< pieces of the flat part, so that it can be bent
};

/// A closed box; the middle of its bottom is the origin.
[[nodiscard]] Mesh make_box(const Eigen::Vector3d& size,
                            const BoxSurfaces& surfaces,
                            const Rounding& rounding = {});

/// A closed box whose top may be larger or smaller than its bottom, or stand askew on it.
struct TaperedBox {
  Eigen::Vector2d bottom_size = Eigen::Vector2d::Ones();
  Eigen::Vector2d top_size = Eigen::Vector2d::Ones();
  double height = 1;
  Eigen::Vector2d top_offset = Eigen::Vector2d::Zero();
};
/// The middle of its bottom is the origin.
[[nodiscard]] Mesh make_tapered_box(const TaperedBox& shape, const BoxSurfaces& surfaces);

/// A corner of the outline that a lathe turns about the z axis.
struct ProfilePoint {
  double radius = 0;
  double z = 0;
  Surface surface{};  ///< of the stretch from here to the next point
};

/// Turns a profile about the z axis. Outside is to the right of the way along the profile (radius
/// to the right, z up): upwards on an outer wall. Closed where the profile begins and ends at
/// radius 0. A picture covers one turn and all consecutive stretches with the same surface.
[[nodiscard]] Mesh make_lathe(const std::vector<ProfilePoint>& profile, int segments);

/// A round bar along a line of points, with a radius for each end, and round ends.
struct Tube {
  std::vector<Eigen::Vector3d> path;
  double start_radius = 0.01;
  double end_radius = 0.01;
};
[[nodiscard]] Mesh make_tube(const Tube& tube, const Surface& surface, int segments = 10);

/// A thin curved plate. `place` maps (u, v), u to the right and v downwards as seen from the front,
/// each in [0, 1], to the middle of the plate.
struct Sheet {
  std::function<Eigen::Vector3d(double u, double v)> place;
  int columns = 8;
  int rows = 8;
  double thickness = 0.001;
};
/// Closed: front, back and rim.
[[nodiscard]] Mesh make_sheet(const Sheet& sheet, const Surface& front, const Surface& back);

/// Bends a mesh that is flat across x: x += (along_y * y^2 + along_z * z^2) / 2.
struct Bend {
  double along_y = 0;  ///< curvature, 1/m
  double along_z = 0;
};
[[nodiscard]] Mesh bent(Mesh mesh, const Bend& bend);

}  // namespace stillmap
