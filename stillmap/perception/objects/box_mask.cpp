// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/box_mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/objects/boxes.hpp"
#include "stillmap/perception/objects/cell_grid.hpp"
#include "stillmap/perception/objects/object_depth.hpp"

namespace stillmap {
namespace {

constexpr int kLeastSide_px = 16;       // of a box
constexpr double kFills = 0.3;          // least share of its box that a person covers
constexpr double kHardlyAny = 0.1;      // share of its box that a mask has whose pixels others got
constexpr double kRoughReach = 0.05;    // of a rough mask around its box, as a share of its side
constexpr double kLeastMeasured = 0.2;  // share of a rough mask with depth, else it stays

/// The pixels of `area` that belong to the object by the grid; those without depth by the rough
/// mask if there is one.
PixelPatch pixels_of_object(const CellGrid& grid,
                            const DepthImage& depth,
                            const ObjectMask& mask,
                            cv::Rect area,
                            int rough_id) {
  PixelPatch patch{area, cv::Mat1b(area.size(), std::uint8_t{0})};
  const auto id_at = [&](int y, int x) { return mask.mat.empty() ? 0 : int{mask.mat(y, x)}; };
  // Cells leave out some of the last rows and columns.
  if (rough_id != 0) cv::Mat1b((mask.mat(area) == rough_id) & 1).copyTo(patch.pixels);
  for (int i = 0; i < grid.size(); ++i) {
    const cv::Rect cell = grid.cell(i) & area;
    const float reach = 0.05F + 0.02F * grid.depth(i);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        const float z = depth.mat(y, x);
        const int id = id_at(y, x);
        const bool own = rough_id != 0 && id == rough_id;
        const bool near = own || std::abs(z - grid.depth(i)) < reach;
        const bool undecided = !(grid.depth(i) > 0);
        const bool joins = z > 0 ? (grid.is_object(i) && near) || (undecided && own)
                                 : own || (rough_id == 0 && grid.is_object(i));
        patch.pixels(y - area.y, x - area.x) = (id == 0 || own) && joins ? 1 : 0;
      }
    }
  }
  return patch;
}

PixelBox widened(const PixelBox& box, double share) {
  const double x = share * box.width(), y = share * box.height();
  return {box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y};
}

/// Descending score; rough masks before boxes alone, which get what these leave.
std::vector<std::size_t> order_of_completion(const FrameDetections& detections) {
  std::vector<std::size_t> order(detections.objects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) {
    const DetectedObject& object = detections.objects[i];
    return std::pair(object.pixel_source == PixelSource::kRoughNetwork, object.score);
  });
  return order;
}

/// Gives the pixels that a rough mask has lost to those of `others` whose boxes they fill as a
/// person would, and that have hardly any pixels, the first first: somebody is there, at another
/// depth.
void pass_on(cv::Mat1b& mask,
             const cv::Mat1b& before,
             std::span<const std::size_t> others,
             const std::vector<DetectedObject>& objects,
             MaskAreas& areas) {
  const cv::Mat1b lost = before & (mask == 0);
  for (const std::size_t i : others) {
    const DetectedObject& other = objects[i];
    if (other.pixel_source != PixelSource::kRoughNetwork) continue;
    const cv::Rect box = pixels_of(other.box, mask.size());
    if (box.empty()) continue;
    std::size_t& pixels = areas[static_cast<std::size_t>(other.id)].pixels;
    const int gained = cv::countNonZero(lost(box));
    if (gained < kFills * box.area()) continue;
    if (static_cast<double>(pixels) > kHardlyAny * box.area()) continue;
    pixels += static_cast<std::size_t>(gained);
    mask(box).setTo(other.id, lost(box));
    lost(box).setTo(0);
  }
}

}  // namespace

PixelPatch mask_from_depth(const DepthImage& depth,
                           const ObjectMask& mask,
                           const PixelBox& box,
                           std::optional<float> expected_depth_m) {
  STILLMAP_CHECK(mask.mat.empty() || mask.mat.size() == depth.mat.size());
  const cv::Rect pixels = pixels_of(box, depth.mat.size());
  if (pixels.width < kLeastSide_px || pixels.height < kLeastSide_px) return {};
  CellGrid grid(depth, mask, box, 0);
  const std::optional<float> layer = grid.layer(expected_depth_m);
  if (!layer) return {};
  grid.divide(*layer);
  return pixels_of_object(grid, depth, mask, pixels, 0);
}

PixelPatch mask_refined_by_depth(const DepthImage& depth,
                                 const ObjectMask& mask,
                                 const DetectedObject& object) {
  STILLMAP_CHECK(mask.mat.size() == depth.mat.size());
  const PixelBox box = widened(object.box, kRoughReach);
  const cv::Rect pixels = pixels_of(box, depth.mat.size());
  if (pixels.width < kLeastSide_px || pixels.height < kLeastSide_px) return {};
  CellGrid grid(depth, mask, box, object.id);
  const std::optional<float> layer = grid.layer(std::nullopt);
  if (!layer || grid.measured_share() < kLeastMeasured) return {};
  grid.divide(*layer);
  return pixels_of_object(grid, depth, mask, pixels, object.id);
}

std::vector<bool> complete_masks(FrameDetections& detections,
                                 const DepthImage& depth,
                                 const std::vector<std::optional<float>>& expected_depths_m) {
  STILLMAP_CHECK(expected_depths_m.size() == detections.objects.size());
  MaskAreas areas = mask_areas(detections.mask);  // their numbers of pixels, before completion
  std::vector<bool> completed(detections.objects.size(), false);
  bool own = false;  // the mask's pixels may be shared with the caller
  const std::vector<std::size_t> order = order_of_completion(detections);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    DetectedObject& object = detections.objects[i];
    const bool has_pixels = areas[static_cast<std::size_t>(object.id)].pixels > 0;
    if (has_pixels && object.pixel_source != PixelSource::kRoughNetwork) continue;
    const PixelPatch patch =
        has_pixels ? mask_refined_by_depth(depth, detections.mask, object)
                   : mask_from_depth(depth, detections.mask, object.box, expected_depths_m[i]);
    object.pixel_source = has_pixels ? PixelSource::kNetwork : object.pixel_source;
    if (patch.area.empty() || cv::countNonZero(patch.pixels) == 0) continue;
    if (!own) {
      detections.mask =
          ObjectMask(detections.mask.mat.empty() ? cv::Mat1b(depth.mat.size(), std::uint8_t{0})
                                                 : cv::Mat1b(detections.mask.mat.clone()));
      own = true;
    }
    const auto id = static_cast<std::uint8_t>(object.id);
    if (has_pixels) {
      const cv::Mat1b before = detections.mask.mat == object.id;
      detections.mask.mat.setTo(0, before);
      paint(detections.mask, patch, id);
      const auto others = std::span(order).subspan(k + 1);
      pass_on(detections.mask.mat, before, others, detections.objects, areas);
    } else {
      paint(detections.mask, patch, id);
      object.pixel_source = PixelSource::kDepth;
      completed[i] = true;
    }
  }
  return completed;
}

}  // namespace stillmap
