// SPDX-License-Identifier: Apache-2.0
#include "tests/support/plane_sequence.hpp"

#include <random>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kFocal_px = 300, kWall_m = 1.5, kBoard_m = 0.9;

cv::Mat3b random_picture(std::uint32_t seed) {
  std::mt19937 rng(seed);
  cv::Mat3b picture(2 * kHeight, 2 * kWidth, cv::Vec3b(128, 128, 128));
  for (int i = 0; i < 1200; ++i) {
    const int x = static_cast<int>(rng() % (2 * kWidth)),
              y = static_cast<int>(rng() % (2 * kHeight));
    const int w = 4 + static_cast<int>(rng() % 24), h = 4 + static_cast<int>(rng() % 24);
    const auto channel = [&] { return static_cast<double>(rng() % 256); };
    cv::rectangle(picture, {x, y, w, h}, {channel(), channel(), channel()}, cv::FILLED);
  }
  cv::GaussianBlur(picture, picture, {3, 3}, 0);
  return picture;
}

// The image of a picture on a plane at `depth_m`, from a camera at (x, y) metres.
template <class Picture>
Picture seen(const Picture& picture, double x_m, double y_m, double depth_m) {
  const double x_px = 20 + x_m * kFocal_px / depth_m, y_px = 20 + y_m * kFocal_px / depth_m;
  Picture image;
  cv::warpAffine(picture,
                 image,
                 cv::Matx23d(1, 0, x_px, 0, 1, y_px),
                 {kWidth, kHeight},
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  return image;
}

CameraModel plane_camera() {
  CameraModel camera;
  camera.name = "plane";
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  camera.fx = camera.fy = kFocal_px;
  camera.cx = kWidth / 2.0;
  camera.cy = kHeight / 2.0;
  return camera;
}

// The position in the picture of a plane at `depth_m` that a ray meets, from a camera at (x, y).
cv::Point2f picture_position(const cv::Vec2f& ray, double x_m, double y_m, double depth_m) {
  const double scale = kFocal_px / depth_m;
  return {static_cast<float>(20 + kWidth / 2.0 + (x_m + ray[0] * depth_m) * scale),
          static_cast<float>(20 + kHeight / 2.0 + (y_m + ray[1] * depth_m) * scale)};
}

constexpr int kBoardX_px = 120, kBoardY_px = 60, kBoardWidth_px = 140, kBoardHeight_px = 150;

bool on_board(const cv::Vec2f& ray, double x_m, double y_m) {
  const cv::Point2f at = picture_position(ray, x_m, y_m, kBoard_m);
  return at.x >= kBoardX_px && at.y >= kBoardY_px && at.x < kBoardX_px + kBoardWidth_px &&
         at.y < kBoardY_px + kBoardHeight_px;
}

cv::Mat3b seen_by_rays(
    const cv::Mat3b& picture, const cv::Mat2f& rays, double x_m, double y_m, double depth_m) {
  cv::Mat2f positions(rays.size());
  for (int row = 0; row < rays.rows; ++row) {
    for (int column = 0; column < rays.cols; ++column) {
      const cv::Point2f at = picture_position(rays(row, column), x_m, y_m, depth_m);
      positions(row, column) = {at.x, at.y};
    }
  }
  cv::Mat3b image;
  cv::remap(picture, image, positions, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  return image;
}

cv::Mat1b board_by_rays(const cv::Mat2f& rays, double x_m, double y_m) {
  cv::Mat1b board(rays.size());
  for (int row = 0; row < rays.rows; ++row) {
    for (int column = 0; column < rays.cols; ++column) {
      board(row, column) = on_board(rays(row, column), x_m, y_m) ? 255 : 0;
    }
  }
  return board;
}

}  // namespace

void write_plane_sequence(const std::filesystem::path& folder,
                          int frames,
                          const CameraModel& camera) {
  std::filesystem::create_directories(folder / "rgb");
  std::filesystem::create_directories(folder / "depth");
  const cv::Mat3b wall = random_picture(5), board = random_picture(6);
  const cv::Mat2f rays = pixel_rays(camera);
  const DepthCamera depth_camera = camera.depth_camera
                                       ? *camera.depth_camera
                                       : DepthCamera{camera, Eigen::Isometry3d::Identity()};
  const cv::Mat2f depth_rays = pixel_rays(depth_camera.camera);
  const Eigen::Vector3d beside = depth_camera.T_color_depth.translation();
  std::string list, poses;
  for (int i = 0; i < frames; ++i) {
    const std::string stamp = fmt::format("{:.6f}", 100 + i / 30.0);
    const double x_m = 0.002 * i, y_m = 0.001 * i;
    cv::Mat3b image = seen_by_rays(wall, rays, x_m, y_m, kWall_m);
    seen_by_rays(board, rays, x_m, y_m, kBoard_m).copyTo(image, board_by_rays(rays, x_m, y_m));
    cv::Mat1f depth(depth_rays.size(), static_cast<float>(kWall_m));
    depth.setTo(kBoard_m, board_by_rays(depth_rays, x_m + beside.x(), y_m + beside.y()));
    write_file_atomically(folder / "rgb" / (stamp + ".png"), encode_png(ColorImage(image)));
    write_file_atomically(folder / "depth" / (stamp + ".png"),
                          encode_depth_png(DepthImage(depth), camera.depth_factor));
    list += fmt::format("{0} DIR/{0}.png\n", stamp);
    poses += fmt::format("{} {:.6f} {:.6f} 0 0 0 0 1\n", stamp, x_m, y_m);
  }
  for (const std::string name : {"rgb", "depth"}) {
    std::string named = list;
    for (std::size_t at = 0; (at = named.find("DIR", at)) != std::string::npos;) {
      named.replace(at, 3, name);
    }
    write_file_atomically(folder / (name + ".txt"), named);
  }
  write_file_atomically(folder / "groundtruth.txt", poses);
  write_file_atomically(folder / "camera.yaml", format_camera_yaml(camera));
}

void write_plane_sequence(const std::filesystem::path& folder, int frames) {
  std::filesystem::create_directories(folder / "rgb");
  std::filesystem::create_directories(folder / "depth");
  const CameraModel camera = plane_camera();
  const cv::Mat3b wall = random_picture(5), board = random_picture(6);
  cv::Mat1b board_area = cv::Mat1b::zeros(board.size());
  board_area(cv::Rect(120, 60, 140, 150)).setTo(255);

  std::string rgb_list, depth_list, poses;
  for (int i = 0; i < frames; ++i) {
    const std::string stamp = fmt::format("{:.6f}", 100 + i / 30.0);
    const double x_m = 0.002 * i, y_m = 0.001 * i;
    cv::Mat3b image = seen(wall, x_m, y_m, kWall_m);
    const cv::Mat1b is_board = seen(board_area, x_m, y_m, kBoard_m) > 127;
    seen(board, x_m, y_m, kBoard_m).copyTo(image, is_board);
    cv::Mat1f depth(kHeight, kWidth, static_cast<float>(kWall_m));
    depth.setTo(kBoard_m, is_board);
    write_file_atomically(folder / "rgb" / (stamp + ".png"), encode_png(ColorImage(image)));
    write_file_atomically(folder / "depth" / (stamp + ".png"),
                          encode_depth_png(DepthImage(depth), camera.depth_factor));
    rgb_list += fmt::format("{0} rgb/{0}.png\n", stamp);
    depth_list += fmt::format("{0} depth/{0}.png\n", stamp);
    poses += fmt::format("{} {:.6f} {:.6f} 0 0 0 0 1\n", stamp, x_m, y_m);
  }
  write_file_atomically(folder / "rgb.txt", rgb_list);
  write_file_atomically(folder / "depth.txt", depth_list);
  write_file_atomically(folder / "groundtruth.txt", poses);
  write_file_atomically(folder / "camera.yaml", format_camera_yaml(camera));
}

}  // namespace stillmap
