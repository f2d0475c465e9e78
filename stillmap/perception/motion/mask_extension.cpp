// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/mask_extension.hpp"

#include <algorithm>
#include <cstdint>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/motion/depth_growth.hpp"
#include "stillmap/perception/objects/boxes.hpp"

namespace stillmap {
namespace {

constexpr double kReferencePixels = 640.0 * 480.0;

bool is_mask(const ObjectView& object, int row, int x) {
  return object.mask.mat(row, x) == object.id;
}

PixelPatch paper_extension(const ObjectView& object,
                           const MaskArea& area,
                           const ObjectDepths& depths,
                           const MaskExtensionConfig& config) {
  const cv::Size image = object.depth.mat.size();
  const cv::Rect box = pixels_of(object.box, image);
  const double pixels_at_reference =
      static_cast<double>(area.pixels) * kReferencePixels / static_cast<double>(image.area());
  const bool whole_box = pixels_at_reference < config.whole_box_px;
  PixelPatch patch{box | area.bounds, {}};  // a mask may extend beyond its box
  patch.pixels = cv::Mat1b(patch.area.size(), std::uint8_t{0});
  if (whole_box && !box.empty()) patch.pixels(box - patch.area.tl()).setTo(1);
  const DepthInterval within = depths.interval.value_or(DepthInterval{0.0F, 0.0F});
  for (int v = 0; v < patch.area.height; ++v) {
    const int row = patch.area.y + v;
    std::uint8_t* pixel = patch.pixels[v];
    for (int u = 0; u < patch.area.width; ++u) {
      const int x = patch.area.x + u;
      const float z = object.depth.mat(row, x);
      const bool joins = z > within.min_m && z < within.max_m && box.contains({x, row});
      if (joins || (area.pixels > 0 && is_mask(object, row, x))) pixel[u] = 1;
    }
  }
  return patch;
}

/// The part of the image to which the object may grow.
cv::Rect growth_area(const ObjectView& object, const MaskArea& area, double margin) {
  const cv::Size image = object.depth.mat.size();
  const double reach = margin * std::max(object.box.width(), object.box.height());
  const PixelBox wide{
      object.box.x0 - reach, object.box.y0 - reach, object.box.x1 + reach, object.box.y1 + reach};
  return pixels_of(wide, image) | area.bounds;
}

}  // namespace

OutlierRule outlier_rule(const MaskExtensionConfig& config) {
  return {config.mad_factor, config.variant == "paper" ? 0.0 : config.reach_m};
}

PixelPatch mask_patch(const ObjectView& object, const MaskArea& area) {
  if (area.pixels == 0) return {};
  return {area.bounds, cv::Mat1b(object.mask.mat(area.bounds) == object.id)};
}

PixelPatch extend_mask(const ObjectView& object,
                       const MaskArea& area,
                       const ObjectDepths& depths,
                       const MaskExtensionConfig& config,
                       const HalfDepth& known_static) {
  STILLMAP_CHECK(area.pixels == 0 || object.mask.mat.size() == object.depth.mat.size());
  if (config.variant == "paper") return paper_extension(object, area, depths, config);
  if (area.pixels == 0) return {};
  if (!depths.interval) return mask_patch(object, area);
  GrowthRule rule;
  rule.seeds = *depths.interval;
  rule.margin_m = static_cast<float>(config.interval_margin_m);
  rule.large_part = config.large_part;
  rule.step_m = static_cast<float>(config.step_m);
  rule.step_per_m = static_cast<float>(config.step_per_m);
  rule.longest_way_px = config.grow_px * object.depth.mat.cols / 640;
  rule.min_mask_share = config.min_mask_share;
  rule.drop_outliers = config.drop_outliers;
  rule.known_static = known_static;
  rule.static_m = static_cast<float>(config.static_m);
  rule.static_per_m = static_cast<float>(config.static_per_m);
  return grow_in_depth(object, growth_area(object, area, config.box_margin), rule);
}

}  // namespace stillmap
