// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "tooling/report/map_picture.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {

/// The viewpoint on a map: behind the cameras, on their left, or straight above.
enum class MapSide { kFront, kLeft, kTop };

/// The map without the points above the cameras (without cameras: more than 1.9 m above the lowest
/// point), and without strays far outside the scene. Labels are left out.
[[nodiscard]] PointCloud cut_open(const PointCloud& map, const SceneFrame& scene);

struct ViewSize {
  int width_px = 640;
  int height_px = 480;
};

/// A view of a scene that the points of `map` fill, except a few at its rims.
[[nodiscard]] View view_from(MapSide side,
                             const SceneFrame& scene,
                             const PointCloud& map,
                             const ViewSize& size);

/// As render_points(), or render_triangles() where there are triangles, but rendered at twice the
/// size and reduced, so that edges are smooth.
[[nodiscard]] ColorImage render_smooth(const PointCloud& cloud,
                                       const View& view,
                                       Triangles triangles = {});

/// A picture with its name.
struct CaptionedPicture {
  ColorImage image;
  std::string caption;  ///< ASCII; may be empty
};

/// Pictures of equal size row by row, `columns` in a row, with white space between them and the
/// captions on top of each.
[[nodiscard]] ColorImage tile_pictures(std::span<const CaptionedPicture> pictures,
                                       std::size_t columns);

}  // namespace stillmap
