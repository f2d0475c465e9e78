// SPDX-License-Identifier: Apache-2.0
#include "stillmap/report/map_views.hpp"

#include <algorithm>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kGap_px = 12;
constexpr int kCaption_px = 26;

void draw_caption(cv::Mat3b& sheet, const std::string& caption, const cv::Point& base_left) {
  cv::putText(
      sheet, caption, base_left, cv::FONT_HERSHEY_SIMPLEX, 0.55, {40, 40, 40}, 1, cv::LINE_AA);
}

}  // namespace

View view_from(const SceneFrame& scene, MapSide side, int width_px, int height_px) {
  switch (side) {
    case MapSide::kFront:
      return view_turned(scene, {.right = 0, .down = 25 * kDegree}, width_px, height_px);
    case MapSide::kLeft:
      return view_turned(scene, {.right = 60 * kDegree, .down = 35 * kDegree}, width_px, height_px);
    case MapSide::kTop:
      return view_from_above(scene, width_px, height_px);
  }
  STILLMAP_CHECK(false);
}

PointCloud cut_open(const PointCloud& map, const SceneFrame& scene) {
  const double highest = head_height(scene);
  PointCloud cut;
  for (const std::size_t i : points_in_scene(map, scene)) {
    const Eigen::Vector3d p = map.positions[i].cast<double>();
    if (scene.R_level_world.row(1).dot(p) < highest) continue;
    cut.positions.push_back(map.positions[i]);
    cut.colors.push_back(map.colors[i]);
  }
  return cut;
}

ColorImage tile_pictures(std::span<const CaptionedPicture> pictures, std::size_t columns) {
  STILLMAP_CHECK(!pictures.empty() && columns > 0);
  const cv::Size size = pictures.front().image.mat.size();
  const int across = static_cast<int>(std::min(columns, pictures.size()));
  const int down = static_cast<int>((pictures.size() + columns - 1) / columns);
  const bool captioned = std::ranges::any_of(
      pictures, [](const CaptionedPicture& picture) { return !picture.caption.empty(); });
  const int head = captioned ? kCaption_px : 0;
  cv::Mat3b sheet(down * (size.height + head) + (down - 1) * kGap_px,
                  across * size.width + (across - 1) * kGap_px,
                  {255, 255, 255});
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    STILLMAP_CHECK(pictures[i].image.mat.size() == size);
    const int x = static_cast<int>(i % columns) * (size.width + kGap_px);
    const int y = static_cast<int>(i / columns) * (size.height + head + kGap_px);
    pictures[i].image.mat.copyTo(sheet(cv::Rect(cv::Point(x, y + head), size)));
    draw_caption(sheet, pictures[i].caption, {x + 4, y + head - 8});
  }
  return ColorImage(sheet);
}

}  // namespace stillmap
