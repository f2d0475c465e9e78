// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_views.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace stillmap {
namespace {

constexpr Rgb kFloor = {90, 90, 90};
constexpr Rgb kLeftWall = {200, 30, 30};
constexpr Rgb kBackWall = {30, 30, 200};
constexpr Rgb kCeiling = {30, 200, 30};

// 4 m wide, 2.4 m high, 3 m deep, in level axes (y down); the camera is at the origin.
PointCloud room() {
  PointCloud cloud;
  const auto add = [&](double x, double y, double z, Rgb color) {
    cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    cloud.colors.push_back(color);
  };
  for (double u = -2; u <= 2; u += 0.02) {
    for (double v = 1; v <= 4; v += 0.02) {
      add(u, 1.2, v, kFloor);
      add(u, -1.2, v, kCeiling);
    }
    for (double v = -1.2; v <= 1.2; v += 0.02) add(u, v, 4, kBackWall);
  }
  for (double v = -1.2; v <= 1.2; v += 0.02) {
    for (double w = 1; w <= 4; w += 0.02) add(-2, v, w, kLeftWall);
  }
  return cloud;
}

SceneFrame scene_of(const PointCloud& map) {
  return scene_frame(map, {{.stamp = {0, "0"}, .T_world_camera = Eigen::Isometry3d::Identity()}});
}

// The middle and the number of the pixels of a colour.
struct Patch {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double pixels = 0;
};
Patch patch(const ColorImage& image, Rgb color) {
  Patch result;
  for (int v = 0; v < image.mat.rows; ++v) {
    for (int u = 0; u < image.mat.cols; ++u) {
      const cv::Vec3b c = image.mat(v, u);
      if (c != cv::Vec3b(color[0], color[1], color[2])) continue;
      result.center += Eigen::Vector2d(u, v);
      ++result.pixels;
    }
  }
  result.center /= std::max(result.pixels, 1.0);
  return result;
}

ColorImage picture(MapSide side) {
  const PointCloud map = room();
  const SceneFrame scene = scene_of(map);
  const PointCloud cut = cut_open(map, scene);
  View view = view_from(side, scene, cut, {320, 240});
  view.shade_depth_steps = false;
  return render_points(cut, view);
}

TEST(CutOpen, TakesTheCeilingAndStraysAway) {
  PointCloud map = room();
  map.positions.emplace_back(500.0F, 0.0F, 0.0F);
  map.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  map.colors.resize(map.size());
  const PointCloud cut = cut_open(map, scene_of(map));
  ASSERT_GT(cut.size(), 1000U);
  ASSERT_EQ(cut.size(), cut.colors.size());
  for (std::size_t i = 0; i < cut.size(); ++i) {
    EXPECT_GE(cut.positions[i].y(), -0.41F);  // 0.4 m over the camera
    EXPECT_LE(cut.positions[i].x(), 10.0F);
    EXPECT_NE(cut.colors[i], kCeiling);
  }
}

TEST(CutOpen, GoesByTheFloorWhereThereAreNoCameras) {
  const PointCloud map = room();
  const PointCloud cut = cut_open(map, scene_frame(map, {}));
  ASSERT_GT(cut.size(), 1000U);
  float highest = 1;
  for (const Eigen::Vector3f& p : cut.positions) highest = std::min(highest, p.y());
  EXPECT_NEAR(highest, 1.2 - 1.9, 0.05);
}

TEST(ViewFrom, FrontHasTheBackWallUpAndTheLeftWallLeft) {
  const ColorImage image = picture(MapSide::kFront);
  EXPECT_GT(patch(image, kBackWall).pixels, 1000);
  EXPECT_LT(patch(image, kBackWall).center.y(), patch(image, kFloor).center.y());
  EXPECT_NEAR(patch(image, kBackWall).center.x(), 160, 20);
  EXPECT_LT(patch(image, kLeftWall).center.x(), 80);
}

TEST(ViewFrom, LeftHasTheBackWallLeft) {
  const ColorImage image = picture(MapSide::kLeft);
  EXPECT_GT(patch(image, kBackWall).pixels, 500);
  EXPECT_LT(patch(image, kBackWall).center.x(), patch(image, kFloor).center.x());
}

TEST(ViewFrom, TopIsAPlan) {
  const ColorImage image = picture(MapSide::kTop);
  // 4 m by 3 m fill 320 by 240 pixels to 95 %: 76 pixels a metre; most of it is floor.
  EXPECT_NEAR(patch(image, kFloor).pixels, 0.95 * 0.95 * 320 * 240, 0.06 * 320 * 240);
  EXPECT_LT(patch(image, kBackWall).center.y(), 15);
  EXPECT_LT(patch(image, kLeftWall).center.x(), 15);
}

TEST(ViewFrom, FillsThePictureFromAllSides) {
  for (const MapSide side : {MapSide::kFront, MapSide::kLeft, MapSide::kTop}) {
    const PointCloud map = room();
    const SceneFrame scene = scene_of(map);
    const View view = view_from(side, scene, map, {320, 240});
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3f& p : map.positions) {
      const std::optional<Eigen::Vector3d> px = project_point(view, p.cast<double>());
      if (px) box.extend(Eigen::Vector2d(px->head<2>()));
    }
    EXPECT_GT(std::max(box.sizes().x() / 320, box.sizes().y() / 240), 0.9);
    EXPECT_LT(std::max(box.sizes().x() / 320, box.sizes().y() / 240), 1.1);
    EXPECT_LT((box.center() - Eigen::Vector2d(160, 120)).norm(), 20);
  }
}

TEST(RenderSmooth, IsTheSamePictureWithoutSteps) {
  const PointCloud map = room();
  const View view = view_from(MapSide::kTop, scene_of(map), map, {320, 240});
  const cv::Mat3b plain = render_points(map, view).mat, smooth = render_smooth(map, view).mat;
  ASSERT_EQ(smooth.size(), plain.size());
  EXPECT_LT(cv::norm(smooth, plain, cv::NORM_L1), 12.0 * 3 * 320 * 240);
  // Half of a pixel that a point covers is half its color.
  PointCloud point;
  point.positions = {{0.0025F, 0.0025F, 1.0F}};
  point.colors = {{0, 0, 0}};
  View near;
  near.width_px = near.height_px = 32;
  near.scale = 100;
  near.point_size_m = 0.005;  // half a pixel, of the four in the large picture
  near.shade_depth_steps = false;
  EXPECT_EQ(render_points(point, near).mat(16, 16), cv::Vec3b(0, 0, 0));
  EXPECT_NEAR(render_smooth(point, near).mat(16, 16)[0], 255 * 3 / 4, 1);
}

TEST(TilePictures, LieInRowsWithCaptionsOverThem) {
  const auto plain = [](std::uint8_t level) {
    return ColorImage(cv::Mat3b(20, 30, cv::Vec3b(level, level, level)));
  };
  const std::vector<CaptionedPicture> pictures = {
      {plain(10), ""}, {plain(20), ""}, {plain(30), ""}};
  const cv::Mat3b two = tile_pictures(pictures, 2).mat;
  ASSERT_EQ(two.size(), cv::Size(30 + 12 + 30, 20 + 12 + 20));
  EXPECT_EQ(two(0, 0)[0], 10);
  EXPECT_EQ(two(0, 42)[0], 20);
  EXPECT_EQ(two(32, 0)[0], 30);
  EXPECT_EQ(two(32, 42)[0], 255);
  EXPECT_EQ(two(0, 35)[0], 255);

  const std::vector<CaptionedPicture> named = {{plain(10), "front"}};
  const cv::Mat3b one = tile_pictures(named, 4).mat;
  ASSERT_EQ(one.size(), cv::Size(30, 20 + 26));
  EXPECT_EQ(one(26, 0)[0], 10);
  const cv::Mat3b head = one.rowRange(0, 26);
  EXPECT_TRUE(std::any_of(head.begin(), head.end(), [](const cv::Vec3b& c) { return c[0] < 128; }));
}

TEST(ViewFrom, OfAnEmptyMapIsAView) {
  const View view = view_from(MapSide::kFront, scene_frame({}, {}), {}, {320, 240});
  EXPECT_EQ(render_points({}, view).mat.size(), cv::Size(320, 240));
}

}  // namespace
}  // namespace stillmap
