// SPDX-License-Identifier: Apache-2.0
// Another project that uses the installed stillmap: something of its lowest module, of one whose
// private libraries have to be found too, and of the top.
#include <fmt/core.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/optim/pose_graph.hpp"
#include "stillmap/system/system.hpp"

namespace {

struct Settings {
  double speed_m_per_s = 1.5;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_m_per_s", self.speed_m_per_s, stillmap::FieldInfo{"how fast", "m/s"});
  }
};

}  // namespace

int main() {
  const stillmap::CameraModel camera = stillmap::builtin_camera("tum_fr3");
  fmt::print("camera {}: {} x {}\n", camera.name, camera.width_px, camera.height_px);
  stillmap::System slam({}, camera, {.threads = 2});
  if (!slam.finish().trajectory.empty()) return 1;
  if (!stillmap::optimize_pose_graph({}, {}).T_world.empty()) return 1;
  Settings settings;
  fmt::print("{}", stillmap::dump_yaml(stillmap::list_fields(settings)));
  try {
    stillmap::load_yaml(stillmap::list_fields(settings), "no such file.yaml");
  } catch (const stillmap::Error&) {
    return 0;
  }
  return 1;
}
