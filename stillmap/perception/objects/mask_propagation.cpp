// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/mask_propagation.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/objects/boxes.hpp"

namespace stillmap {
namespace {

/// The pixel of the other frame for each of `count` pixels from `first` on; -1 outside its image.
std::vector<int> source_places(int first,
                               int count,
                               double from_begin,
                               double from_size,
                               double begin,
                               double size,
                               int limit) {
  std::vector<int> places(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double place = from_begin + (first + i + 0.5 - begin) * from_size / size;
    places[static_cast<std::size_t>(i)] =
        place >= 0 && place < limit ? static_cast<int>(place) : -1;
  }
  return places;
}

cv::Mat1b moved_pixels(const ObjectView& from, const PixelBox& box, const cv::Rect& area) {
  const cv::Mat1b& ids = from.mask.mat;
  const PixelBox& old = from.box;
  const std::vector<int> columns =
      source_places(area.x, area.width, old.x0, old.width(), box.x0, box.width(), ids.cols);
  const std::vector<int> rows =
      source_places(area.y, area.height, old.y0, old.height(), box.y0, box.height(), ids.rows);
  cv::Mat1b pixels(area.size(), std::uint8_t{0});
  for (int v = 0; v < area.height; ++v) {
    const int row = rows[static_cast<std::size_t>(v)];
    if (row < 0) continue;
    const std::uint8_t* source = ids[row];
    std::uint8_t* target = pixels[v];
    for (int u = 0; u < area.width; ++u) {
      const int column = columns[static_cast<std::size_t>(u)];
      target[u] = column >= 0 && source[column] == from.id ? 1 : 0;
    }
  }
  return pixels;
}

struct Refinement {
  int carried = 0;
  int kept = 0;
};

/// Removes the pixels of `patch` whose depth does not fit.
Refinement refine(PixelPatch& patch, const DepthImage& depth, const DepthInterval& fitting) {
  Refinement counts;
  for (int v = 0; v < patch.area.height; ++v) {
    const float* z = depth.mat[patch.area.y + v] + patch.area.x;
    std::uint8_t* pixel = patch.pixels[v];
    for (int u = 0; u < patch.area.width; ++u) {
      if (pixel[u] == 0) continue;
      ++counts.carried;
      if (z[u] > 0 && !fitting.contains(z[u])) pixel[u] = 0;
      counts.kept += pixel[u];
    }
  }
  return counts;
}

}  // namespace

PropagatedMask propagate_mask(const ObjectView& from,
                              const MaskArea& from_area,
                              const PixelBox& box,
                              const DepthImage& depth,
                              const PropagationRule& rule) {
  const cv::Rect area = pixels_of(box, depth.mat.size());
  PropagatedMask carried{{area, cv::Mat1b(area.size(), std::uint8_t{1})}, MaskSource::kBox};
  if (from.mask.mat.empty() || area.empty()) return carried;
  STILLMAP_CHECK(from.mask.mat.size() == depth.mat.size());
  if (from_area.pixels == 0) return carried;
  PixelPatch patch{area, moved_pixels(from, box, area)};
  const ObjectDepths depths =
      object_depths(from.depth, from.mask, from.id, from_area, rule.outliers);
  DepthInterval fitting{0.0F, 1e9F};  // without known depth every depth fits
  if (depths.interval) {
    const auto margin = static_cast<float>(rule.depth_margin_m);
    fitting = {depths.interval->min_m - margin, depths.interval->max_m + margin};
  }
  const Refinement counts = refine(patch, depth, fitting);
  if (counts.kept == 0 || counts.kept < rule.min_kept_share * counts.carried) return carried;
  return {patch, MaskSource::kCarried};
}

}  // namespace stillmap
