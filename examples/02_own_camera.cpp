// SPDX-License-Identifier: Apache-2.0
// A camera of one's own: images in, poses out, while the camera runs.
#include <cstdio>

#include "examples/wall_camera.hpp"
#include "stillmap/system/system.hpp"

int main() {
  WallCamera camera;  // in a robot: the driver of its camera
  stillmap::System slam({}, WallCamera::model(), {.threads = 2});
  stillmap::FrameResult result;
  for (int i = 0; i < 40; ++i) {
    const stillmap::RgbdFrame frame = camera.grab();
    result = slam.process(frame);
    if (!stillmap::has_pose(result)) {
      std::printf("%s: lost\n", result.stamp.text.c_str());
      continue;
    }
    const Eigen::Vector3d p = result.T_world_camera.translation();
    std::printf("%s: %.3f %.3f %.3f\n", result.stamp.text.c_str(), p.x(), p.y(), p.z());
  }
  return stillmap::has_pose(result) ? 0 : 1;
}
