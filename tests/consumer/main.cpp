// SPDX-License-Identifier: Apache-2.0
// Another project that uses the installed stillmap, by its public headers and nothing else. The
// include of every one of them is written by CMake.
#include <cstdio>

#include <all_public_headers.hpp>

int main() {
  const stillmap::CameraModel camera = stillmap::builtin_camera("tum_fr3");
  std::printf("camera %s: %d x %d\n", camera.name.c_str(), camera.width_px, camera.height_px);
  stillmap::Settings settings;
  settings.set("dynamics.mode", "off");
  if (settings.get("dynamics.mode") != "off") return 1;
  stillmap::System slam(settings, camera, {.threads = 2});
  const cv::Mat3b color(camera.height_px, camera.width_px, cv::Vec3b(90, 90, 90));
  const cv::Mat1f depth(camera.height_px, camera.width_px, 2.0F);
  const stillmap::FrameResult result = slam.process(
      stillmap::make_frame(0.0, stillmap::ColorImage(color), stillmap::DepthImage(depth)));
  if (stillmap::has_pose(result)) return 1;  // a grey wall has no feature
  if (!slam.finish().trajectory.empty()) return 1;
  try {
    settings.load("no such file.yaml");
  } catch (const stillmap::Error&) {
    return 0;
  }
  return 1;
}
