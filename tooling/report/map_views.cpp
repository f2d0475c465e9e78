// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_views.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

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

// The bounds of the projected points, without the outer 0.2 % at each edge.
Eigen::AlignedBox2d covered_px(const View& view, const PointCloud& map) {
  std::vector<double> x, y;
  const std::size_t stride = map.size() / 50'000 + 1;
  for (std::size_t i = 0; i < map.size(); i += stride) {
    const std::optional<Eigen::Vector3d> px = project_point(view, map.positions[i].cast<double>());
    if (!px) continue;
    x.push_back(px->x());
    y.push_back(px->y());
  }
  Eigen::AlignedBox2d box;
  if (x.empty()) return box;
  std::ranges::sort(x);
  std::ranges::sort(y);
  const std::size_t outer = x.size() / 500;
  box.extend(Eigen::Vector2d(x[outer], y[outer]));
  box.extend(Eigen::Vector2d(x[x.size() - 1 - outer], y[y.size() - 1 - outer]));
  return box;
}

// The view turned (orthographic: shifted) to the middle of the area that the points cover.
View centered(View view, const Eigen::AlignedBox2d& box, const Eigen::Vector3d& down_world) {
  const Eigen::Isometry3d T_world_camera = view.T_camera_world.inverse();
  const Eigen::Vector2d middle_px(0.5 * view.width_px, 0.5 * view.height_px);
  const Eigen::Vector2d aside = (box.center() - middle_px) / view.scale;
  if (view.orthographic) {
    view.T_camera_world.translation().head<2>() -= aside;
    return view;
  }
  view.T_camera_world = look_at(T_world_camera.translation(),
                                T_world_camera * Eigen::Vector3d(aside.x(), aside.y(), 1),
                                down_world);
  return view;
}

View filled(View view, const PointCloud& map, const Eigen::Vector3d& down_world) {
  constexpr double kFilled = 0.95;
  for (int turn = 0; turn < 2; ++turn) {  // turning changes the covered area slightly
    const Eigen::AlignedBox2d before = covered_px(view, map);
    if (before.isEmpty()) return view;
    view = centered(view, before, down_world);
    const Eigen::Vector2d sizes = covered_px(view, map).sizes().cwiseMax(1.0);
    view.scale *= kFilled * std::min(view.width_px / sizes.x(), view.height_px / sizes.y());
  }
  return view;
}

View rough_view(MapSide side, const SceneFrame& scene, const ViewSize& size) {
  switch (side) {
    case MapSide::kFront:
      return view_along(scene, size.width_px, size.height_px);
    case MapSide::kLeft:
      return view_turned(
          scene, {.right = 60 * kDegree, .down = 35 * kDegree}, size.width_px, size.height_px);
    case MapSide::kTop:
      break;
  }
  View view = view_from_above(scene, size.width_px, size.height_px);
  view.point_size_m *= 1.5;  // in this view, points of one surface lie in rows with gaps
  return view;
}

}  // namespace

View view_from(MapSide side, const SceneFrame& scene, const PointCloud& map, const ViewSize& size) {
  const Eigen::Vector3d down_world = scene.R_level_world.transpose() * Eigen::Vector3d::UnitY();
  return filled(rough_view(side, scene, size), map, down_world);
}

PointCloud cut_open(const PointCloud& map, const SceneFrame& scene) {
  constexpr double kOverFloor_m = 1.9;
  const double highest = scene.cameras.isEmpty() && !scene.box.isEmpty()
                             ? scene.box.max().y() - kOverFloor_m
                             : head_height(scene);
  PointCloud cut;
  for (const std::size_t i : points_in_scene(map, scene)) {
    const Eigen::Vector3d p = map.positions[i].cast<double>();
    if (scene.R_level_world.row(1).dot(p) < highest) continue;
    cut.positions.push_back(map.positions[i]);
    cut.colors.push_back(map.colors[i]);
    if (!map.normals.empty()) cut.normals.push_back(map.normals[i]);
  }
  return cut;
}

ColorImage render_smooth(const PointCloud& cloud, const View& view, Triangles triangles) {
  View large = view;
  large.width_px *= 2;
  large.height_px *= 2;
  large.scale *= 2;
  const ColorImage drawn =
      triangles.empty() ? render_points(cloud, large) : render_triangles(cloud, triangles, large);
  ColorImage picture;
  cv::resize(drawn.mat, picture.mat, {view.width_px, view.height_px}, 0, 0, cv::INTER_AREA);
  return picture;
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
