// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/renderer.hpp"

#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/render_scenes.hpp"

namespace stillmap {
namespace {

// Smooth waves, which any good filter preserves, on a wall; before it a plain square thing with an
// id. No lamps: the light is uniform.
World wall_and_square() {
  World world;
  world.ambient = 1.0;
  cv::Mat3b picture(256, 256);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      picture(y, x) = {cv::saturate_cast<std::uint8_t>(128 + 80 * std::sin(0.15 * x)),
                       cv::saturate_cast<std::uint8_t>(128 + 80 * std::sin(0.11 * y)),
                       cv::saturate_cast<std::uint8_t>(128 + 60 * std::sin(0.07 * (x + y)))};
    }
  }
  const MaterialId waves = world.materials.add({MipTexture(picture), false, 1.F});
  const MaterialId red =
      world.materials.add({MipTexture(cv::Mat3b(1, 1, {230, 20, 20})), false, 1.F});
  world.things.push_back(
      {"wall", "wall", 0, wall(3.0, 3, 3, waves), Eigen::Isometry3d::Identity()});
  world.things.push_back(
      {"square", "box", 13, wall(2.0, 0.4, 0.4, red), Eigen::Isometry3d::Identity()});
  return world;
}

struct Setting {
  std::shared_ptr<const World> world = std::make_shared<const World>(wall_and_square());
  CameraModel camera = small_camera();
  Renderer renderer{world, camera, {.light = {.shadows = false}}};
  Eigen::Isometry3d T_world_camera = looking_along_x(Eigen::Vector3d::Zero());
};

TEST(Renderer, DepthIsThatOfThePlanes) {
  const Setting s;
  const RenderedImage image =
      s.renderer.render(Exposure::still(s.T_world_camera, rest_state(*s.world)));
  for (int y = 0; y < s.camera.height_px; ++y) {
    for (int x = 0; x < s.camera.width_px; ++x) {
      const Eigen::Vector2d ray =
          s.camera.unproject(s.camera.undistort(Eigen::Vector2d(x, y)), 1.0).head<2>();
      const double off_axis = 2.0 * ray.cwiseAbs().maxCoeff();
      if (std::abs(off_axis - 0.4) < 1e-5) continue;  // on the square's edge
      const bool square = off_axis < 0.4;
      EXPECT_NEAR(image.depth.mat(y, x), square ? 2.F : 3.F, 1e-5F);
      EXPECT_EQ(image.ids(y, x), square ? 13 : 0);
    }
  }
}

// The mean of very many still pictures, with a finer raster, while the shutter is open: an
// independent way to the same colour.
cv::Mat3b average_of_stills(const Setting& s, const Exposure& exposure, int times, int finer) {
  CameraModel fine = small_camera(s.camera.width_px * finer, s.camera.height_px * finer);
  fine.cx = finer * (s.camera.cx + 0.5) - 0.5;
  fine.cy = finer * (s.camera.cy + 0.5) - 0.5;
  const Renderer renderer(s.world, fine, {.light = {.shadows = false}, .antialiasing = false});
  cv::Mat3d sum(s.camera.height_px, s.camera.width_px, cv::Vec3d(0, 0, 0));
  for (int k = 0; k < times; ++k) {
    const double time = (k + 0.5) / times;
    const auto between = [&](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
      Eigen::Isometry3d T = a;
      T.translation() = (1 - time) * a.translation() + time * b.translation();
      return T;
    };
    WorldState state = exposure.open;
    for (std::size_t i = 0; i < state.T_world_things.size(); ++i) {
      state.T_world_things[i] =
          between(exposure.open.T_world_things[i], exposure.close.T_world_things[i]);
    }
    const RenderedImage still = renderer.render(Exposure::still(
        between(exposure.T_world_camera_open, exposure.T_world_camera_close), state));
    for (int y = 0; y < fine.height_px; ++y) {
      for (int x = 0; x < fine.width_px; ++x) {
        sum(y / finer, x / finer) += cv::Vec3d(still.color.mat(y, x)) / (times * finer * finer);
      }
    }
  }
  cv::Mat3b mean;
  sum.convertTo(mean, CV_8U);
  return mean;
}

double mean_difference(const cv::Mat3b& a, const cv::Mat3b& b) {
  return cv::norm(a, b, cv::NORM_L1) / (3.0 * static_cast<double>(a.total()));
}

double rms_difference(const cv::Mat3b& a, const cv::Mat3b& b) {
  return cv::norm(a, b, cv::NORM_L2) / std::sqrt(3.0 * static_cast<double>(a.total()));
}

TEST(Renderer, AntialiasingIsTheMeanOverThePixel) {
  const Setting s;
  Exposure exposure = Exposure::still(s.T_world_camera, rest_state(*s.world));
  for (WorldState* state : {&exposure.open, &exposure.close}) {
    state->T_world_things[1].rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  }
  const cv::Mat3b expected = average_of_stills(s, exposure, 1, 8);
  const Renderer jagged(s.world, s.camera, {.light = {.shadows = false}, .antialiasing = false});
  const double smooth = rms_difference(s.renderer.render(exposure).color.mat, expected);
  EXPECT_LT(smooth, 2.5);
  EXPECT_GT(rms_difference(jagged.render(exposure).color.mat, expected), 1.5 * smooth);
}

TEST(Renderer, MotionBlurIsTheMeanOverTheExposure) {
  const Setting s;
  Exposure exposure = Exposure::still(s.T_world_camera, rest_state(*s.world));
  exposure.T_world_camera_open.translation() -= Eigen::Vector3d(0, 0.04, 0.02);
  exposure.T_world_camera_close.translation() += Eigen::Vector3d(0, 0.04, 0.02);
  exposure.open.T_world_things[1].translation() += Eigen::Vector3d(0, 0.08, 0);
  exposure.close.T_world_things[1].translation() -= Eigen::Vector3d(0, 0.08, 0);
  const cv::Mat3b expected = average_of_stills(s, exposure, 32, 4);
  const cv::Mat3b still =
      s.renderer.render(Exposure::still(s.T_world_camera, rest_state(*s.world))).color.mat;
  const double blurred = mean_difference(s.renderer.render(exposure).color.mat, expected);
  EXPECT_LT(blurred, 2.0);
  EXPECT_GT(mean_difference(still, expected), 1.8 * blurred);
}

TEST(Renderer, ShadowsOfALampAreWhereItIsHidden) {
  // Under a lamp of 1 x 1 m at 2 m height a plate at 1 m hides exactly the lamp's half x < 0 from
  // the floor's origin: the part of the floor around it is in half shadow.
  World made;
  made.ambient = 0;
  const MaterialId white = made.materials.add_plain({255, 255, 255});
  Eigen::Isometry3d flat = Eigen::Isometry3d::Identity();  // turns a wall into a floor
  flat.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  const Mesh floor = wall(0.0, 2, 2, white);
  made.things.push_back({"floor", "floor", 0, floor, flat});
  made.things.push_back({"plate", "plate", 0, wall(-1.0, 1, 1, white), flat});
  made.things.back().T_world_thing.translation() = Eigen::Vector3d(-1.0, 0, 0);
  made.lamps.push_back({{0, 0, 2}, {0.5, 0, 0}, {0, 0.5, 0}, 4.0});
  const auto world = std::make_shared<const World>(made);

  // The camera looks down from below the plate.
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T_world_camera.translation() = Eigen::Vector3d(0, 0, 0.9);
  const Renderer renderer(world, small_camera());
  const Renderer shadeless(world, small_camera(), {.light = {.shadows = false}});
  const Exposure exposure = Exposure::still(T_world_camera, rest_state(*world));
  const cv::Mat3b shaded = renderer.render(exposure).color.mat;
  const cv::Mat3b open = shadeless.render(exposure).color.mat;
  const auto light_share = [&](int x) {
    const double with = shaded(36, x)[0] / 255.0, without = open(36, x)[0] / 255.0;
    return with * with / (without * without);
  };
  EXPECT_NEAR(light_share(48), 0.5, 0.1);  // x = 0
  EXPECT_NEAR(light_share(2), 0.0, 0.03);  // x < -0.5: the whole lamp is hidden
  EXPECT_NEAR(light_share(93), 1.0, 0.03);
  // Straight below, 2 m from a lamp of power 4: light 4 / 2^2 = 1, the square root of it is shown.
  EXPECT_NEAR(open(36, 48)[0], 255, 2);
}

TEST(Renderer, GivesEqualBytesInEveryThread) {
  const Setting s;
  Exposure exposure = Exposure::still(s.T_world_camera, rest_state(*s.world));
  exposure.T_world_camera_close.translation() += Eigen::Vector3d(0, 0.04, 0.02);
  const RenderedImage first = s.renderer.render(exposure);
  std::array<RenderedImage, 3> others;
  {
    std::vector<std::jthread> threads;
    for (RenderedImage& image : others) {
      threads.emplace_back([&] { image = s.renderer.render(exposure); });
    }
  }
  for (const RenderedImage& image : others) {
    EXPECT_EQ(cv::norm(first.color.mat, image.color.mat, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(first.depth.mat, image.depth.mat, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(first.ids, image.ids, cv::NORM_INF), 0);
  }
}

}  // namespace
}  // namespace stillmap
