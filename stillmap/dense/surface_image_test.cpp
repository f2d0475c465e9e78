// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/surface_image.hpp"

#include <gtest/gtest.h>

#include "stillmap/dense/local_cloud.hpp"

namespace stillmap {
namespace {

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 80;
  camera.height_px = 64;
  camera.fx = 70;
  camera.fy = 75;
  camera.cx = 39;
  camera.cy = 31;
  return camera;
}

SurfaceImage image_of(const cv::Mat1f& depth) {
  const CameraModel camera = small_camera();
  const ColorImage color(cv::Mat3b(depth.size(), cv::Vec3b(1, 2, 3)));
  LocalCloudConfig config;
  config.cells_across = 20;
  const CompactCloud view = compact(local_cloud(depth, color, pixel_rays(camera), config));
  return surface_image(view, camera, 4);
}

TEST(SurfaceImage, APlaneHasLinearInverseDepth) {
  // n (x, y, 1) z = 1 for the plane n p = 1.
  const Eigen::Vector3d n(0.1, -0.05, 0.5);
  const CameraModel camera = small_camera();
  const cv::Mat2f rays = pixel_rays(camera);
  cv::Mat1f depth(camera.height_px, camera.width_px);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      depth(v, u) = static_cast<float>(1 / n.dot(Eigen::Vector3d(rays(v, u)[0], rays(v, u)[1], 1)));
    }
  }
  const SurfaceImage image = image_of(depth);
  ASSERT_EQ(image.columns, 20);
  ASSERT_EQ(image.rows, 16);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const SurfaceCell& cell = image.at(row, column);
      ASSERT_TRUE(cell.known());
      const double x = (4 * column + 1.5 - camera.cx) / camera.fx;
      const double y = (4 * row + 1.5 - camera.cy) / camera.fy;
      EXPECT_NEAR(cell.inverse_depth, n.dot(Eigen::Vector3d(x, y, 1)), 1e-3);
      EXPECT_NEAR(cell.per_column, n.x() / camera.fx, 1e-4);
      EXPECT_NEAR(cell.per_row, n.y() / camera.fy, 1e-4);
    }
  }
}

TEST(SurfaceImage, CellsWithTwoSurfacesOrNoneAreUnknown) {
  cv::Mat1f depth(64, 80, 2.0F);
  depth(cv::Rect(0, 0, 42, 64)).setTo(1.0F);   // its edge is inside the cells of column 10
  depth(cv::Rect(60, 0, 20, 64)).setTo(0.0F);  // columns 15 to 19
  const SurfaceImage image = image_of(depth);
  for (int row = 0; row < image.rows; ++row) {
    EXPECT_NEAR(image.at(row, 9).inverse_depth, 1.0F, 1e-3F);
    EXPECT_FALSE(image.at(row, 10).known());
    EXPECT_NEAR(image.at(row, 11).inverse_depth, 0.5F, 1e-3F);
    EXPECT_FALSE(image.at(row, 15).known());
    // No surface goes over into that behind it.
    for (const int column : {8, 9, 11, 12, 14}) {
      EXPECT_NEAR(image.at(row, column).per_column, 0, 1e-3) << column;
    }
  }
}

}  // namespace
}  // namespace stillmap
