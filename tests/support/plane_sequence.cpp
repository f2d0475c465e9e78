// SPDX-License-Identifier: Apache-2.0
#include "tests/support/plane_sequence.hpp"

#include <random>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

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

}  // namespace

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
