// SPDX-License-Identifier: Apache-2.0
// Another project that uses the installed stillmap: something of its lowest module and of a higher
// one, whose private libraries have to be found too.
#include <fmt/format.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/core/camera.hpp"
#include "stillmap/core/error.hpp"

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
  Settings settings;
  fmt::print("{}", stillmap::dump_yaml(stillmap::list_fields(settings)));
  try {
    stillmap::load_yaml(stillmap::list_fields(settings), "no such file.yaml");
  } catch (const stillmap::Error&) {
    return 0;
  }
  return 1;
}
