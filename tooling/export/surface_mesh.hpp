// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// A surface of triangles.
struct SurfaceMesh {
  PointCloud vertices;  ///< with normals
  /// Indices of vertices, counter-clockwise as seen from where the normals point.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshOptions {
  double cell_m = 0.02;               ///< edge of the cubes of the surface nets; > 0
  std::size_t most_cells = 50000000;  ///< more cubes near points are refused
};

/// The surface of a map whose points have normals (others do not count).
///
/// The points define a signed distance near them: the weighted mean of the distances to the planes
/// of the points around (Hoppe et al. 1992; weights as in Wendland 1995, zero from 2.5 cells on).
/// It counts where points lie beside the place, not only far to one side, so that the surface
/// ends where the points do. Naive surface nets (Gibson 1998) put one vertex into each cube with a
/// change of sign, and a quad across each edge with one. Vertices take the colour and label of the
/// points around, and the gradient as normal. Vertices and triangles are in a fixed order. Throws
/// Error for more cubes than `most_cells`.
[[nodiscard]] SurfaceMesh surface_mesh(const PointCloud& map, const MeshOptions& options = {});

}  // namespace stillmap
