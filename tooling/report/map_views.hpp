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

/// Where one looks at a map from: behind the cameras, their left, or straight above.
enum class MapSide { kFront, kLeft, kTop };

/// The map without what hangs over the cameras' heads (without cameras: over 1.9 m above the
/// lowest), and without strays far outside the scene.
[[nodiscard]] PointCloud cut_open(const PointCloud& map, const SceneFrame& scene);

struct ViewSize {
  int width_px = 640;
  int height_px = 480;
};

/// A view of a scene that is filled by the points of `map`, but for a few at its rims.
[[nodiscard]] View view_from(MapSide side,
                             const SceneFrame& scene,
                             const PointCloud& map,
                             const ViewSize& size);

/// As render_points(), but rendered twice as large and made smaller, so that edges are smooth.
[[nodiscard]] ColorImage render_smooth(const PointCloud& cloud, const View& view);

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
