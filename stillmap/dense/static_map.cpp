// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/static_map.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/global_cloud.hpp"

namespace stillmap {
namespace {

constexpr int kJumpsPerWidth = 70;
constexpr int kFinestCells = 10000;  // across an image: each cell is a pixel

}  // namespace

CloudConfig CloudConfig::resolved_for(const CloudRules& rules) const {
  CloudConfig config = *this;
  if (depth.edges == "by_mode") config.depth.edges = rules.edges;
  if (depth.islands == "by_mode") config.depth.islands = rules.islands;
  if (fusion.rule == "by_mode") config.fusion.rule = rules.fusion;
  if (free_space == "by_mode") config.free_space = rules.free_space;
  if (missed_people == "by_mode") config.missed_people = rules.missed_people;
  if (view_frames == "by_mode") config.view_frames = rules.view_frames;
  if (points == "by_mode") config.points = rules.points;
  if (config.view_frames == "keyframes") config.view_gap_frames = config.views.enough = 0;
  if (config.points == "pixels") config.local.cells_across = kFinestCells;
  return config;
}

StaticView static_view(const RgbdFrame& frame,
                       const cv::Mat2f& rays,
                       const CloudConfig& config,
                       const DynamicRegions& dynamic_regions,
                       const LabelImage& labels) {
  const cv::Mat1f depth = static_depth(frame.depth.mat, dynamic_regions.excluded, config.depth);
  return {compact(local_cloud(depth, frame.color, rays, config.local, labels)),
          range_image(frame.depth.mat, dynamic_regions, config.range)};
}

PointCloud static_map(std::span<const PosedView> views,
                      const CameraModel& camera,
                      const CloudConfig& config,
                      std::size_t threads) {
  std::vector<PosedCloud> clouds;
  std::vector<PosedRange> ranges;
  for (const PosedView& posed : views) {
    STILLMAP_CHECK(posed.view != nullptr);
    clouds.push_back({posed.T_world_camera, &posed.view->cloud});
    ranges.push_back({posed.T_world_camera, &posed.view->range});
  }
  const PointCloud all = config.fusion.rule == "surface"
                             ? fused_surface(clouds,
                                             camera,
                                             cell_side(camera.width_px, config.local),
                                             config.voxel_size_m,
                                             config.fusion.surface,
                                             threads)
                             : global_cloud(clouds, config.voxel_size_m, threads);
  if (config.free_space != "on") return all;
  return without_moved(all, ranges, camera, config.free, threads);
}

DynamicRegions dynamic_regions(const DynamicMask& mask, const Mask& excluded) {
  if (mask.extended.mat.empty()) return {excluded, {}};
  const int side = std::max(1, mask.jumps.mat.cols / kJumpsPerWidth);
  JumpImage areas;
  cv::morphologyEx(mask.jumps.mat,
                   areas.mat,
                   cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_RECT, cv::Size(side, side)));
  return {excluded, mask.moving(areas)};
}

}  // namespace stillmap
