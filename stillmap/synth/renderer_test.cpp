// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/renderer.hpp"

#include <gtest/gtest.h>

#include "stillmap/synth/camera_path.hpp"
#include "stillmap/synth/sequence.hpp"

namespace stillmap {
namespace {

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::equal(a.datastart, a.dataend, b.datastart);
}

// Depth of the ray through a pixel's centre, box by box without any culling.
double depth_by_first_hit(const Scene& scene,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_world_camera,
                          const cv::Point& pixel) {
  const Eigen::Vector2d raw(pixel.x, pixel.y);
  const Eigen::Vector3d ray = camera.unproject(camera.undistort(raw), 1.0);
  const std::optional<SceneHit> hit =
      first_hit(scene, T_world_camera.translation(), T_world_camera.linear() * ray);
  return hit ? hit->t : 0.0;
}

TEST(Renderer, DepthIsThatOfTheCentreRay) {
  const std::shared_ptr<const Scene> scene = std::make_shared<const Scene>(make_room(1));
  for (const CameraModel& camera : {synthetic_camera(320, 240), builtin_camera("tum_fr1")}) {
    const Renderer renderer(scene, camera);
    for (const double t : {0.0, 7.0, 13.0}) {
      const Eigen::Isometry3d pose = T_world_camera(PathKind::kLoop, t);
      const RenderedImage image = renderer.render(pose);
      int far_off = 0;
      for (int y = 0; y < camera.height_px; y += 3) {
        for (int x = 0; x < camera.width_px; x += 5) {
          const double expected = depth_by_first_hit(*scene, camera, pose, {x, y});
          // A ray along an edge may go either way when its last bits differ.
          far_off += std::abs(image.depth.mat(y, x) - expected) > 1e-4 ? 1 : 0;
        }
      }
      EXPECT_LE(far_off, 2) << camera.name << " at " << t;
    }
  }
}

TEST(Renderer, DoesNotDependOnTheThreads) {
  const Renderer renderer(std::make_shared<const Scene>(make_room(1)), synthetic_camera(321, 200));
  const Eigen::Isometry3d pose = T_world_camera(PathKind::kXyz, 2.0);
  const RenderedImage one = renderer.render(pose, 1);
  for (const int threads : {2, 3, 8}) {
    const RenderedImage many = renderer.render(pose, threads);
    EXPECT_TRUE(same_bytes(one.color.mat, many.color.mat));
    EXPECT_TRUE(same_bytes(one.depth.mat, many.depth.mat));
  }
}

// A plain wall at z = 2 whose left edge is at x = `left`, seen from the origin along z.
std::shared_ptr<const Scene> plain_wall(double left, const Eigen::Vector3d& lamp) {
  Scene scene;
  scene.textures.emplace_back(cv::Mat3b(4, 4, cv::Vec3b(200, 100, 40)));
  SceneBox box;
  box.half_size = Eigen::Vector3d(5, 5, 0.5);
  box.T_world_box.translation() = Eigen::Vector3d(left + 5, 0, 2.5);
  scene.boxes.push_back(box);
  scene.lamp_world = lamp;
  scene.ambient = 0.25;
  return std::make_shared<const Scene>(scene);
}

// fx = fy = 100, the optical axis through pixel (8, 8).
CameraModel small_camera() {
  return {"small", 17, 17, 100, 100, 8, 8, 0, 0, 0, 0, 0, 5000};
}

TEST(Renderer, ShadesAfterLambert) {
  // At the pixel on the axis the light comes in at 60 degrees: 0.25 + 0.75 * 0.5 = 0.625.
  const Eigen::Vector3d lamp(0, 2.0 * std::sqrt(3.0), 0);
  const Renderer renderer(plain_wall(-5, lamp), small_camera());
  const RenderedImage image = renderer.render(Eigen::Isometry3d::Identity());
  const cv::Vec3b color = image.color.mat(8, 8);
  EXPECT_NEAR(color[0], 125, 1);
  EXPECT_NEAR(color[1], 62.5, 1);
  EXPECT_NEAR(color[2], 25, 1);
}

TEST(Renderer, MixesColoursInsideAPixelAtAnEdge) {
  // The edge goes through the centre of column 8, so that two of its four rays meet the wall.
  const Eigen::Vector3d lamp(0, 0, -1e6);  // full light everywhere
  const Renderer renderer(plain_wall(1e-6, lamp), small_camera());
  const RenderedImage image = renderer.render(Eigen::Isometry3d::Identity());
  EXPECT_EQ(image.color.mat(8, 7), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(image.color.mat(8, 8), cv::Vec3b(100, 50, 20));
  EXPECT_EQ(image.color.mat(8, 9), cv::Vec3b(200, 100, 40));
  EXPECT_EQ(image.depth.mat(8, 7), 0.F);
  EXPECT_EQ(image.depth.mat(8, 9), 2.F);
}

TEST(Renderer, CoversAFineCheckerEvenly) {
  // Squares far finer than a pixel must come out as their mean, not as a moire pattern.
  cv::Mat3b checker(1000, 1000);
  for (int y = 0; y < 1000; ++y) {
    for (int x = 0; x < 1000; ++x) checker(y, x) = cv::Vec3b::all((x + y) % 2 == 0 ? 0 : 200);
  }
  Scene scene;
  scene.textures.emplace_back(checker);
  SceneBox box;
  box.half_size = Eigen::Vector3d(1, 1, 0.5);
  box.T_world_box.translation() = Eigen::Vector3d(0, 0, 2.5);
  scene.boxes.push_back(box);
  scene.ambient = 1.0;
  const Renderer renderer(std::make_shared<const Scene>(scene), small_camera());
  const RenderedImage image = renderer.render(Eigen::Isometry3d::Identity());
  for (const cv::Vec3b& color : image.color.mat) EXPECT_NEAR(color[0], 100, 2);
}

}  // namespace
}  // namespace stillmap
