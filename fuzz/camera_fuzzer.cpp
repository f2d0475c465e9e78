// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a camera file, and as truth/objects.json, or refused; what is read is
// written and read again.
#include "fuzz/harness.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::filesystem::path file = folder.put("camera.yaml", bytes);
  const auto check = [&](const CameraModel& camera) {
    require(camera.width_px > 0 && camera.width_px <= 8192 && camera.fx > 0, "a possible camera");
    const std::string text = format_camera_yaml(camera);
    require(format_camera_yaml(read_camera_yaml(folder.put("again.yaml", text))) == text,
            "the same camera");
  };
  read_or_refuse([&] { check(read_camera_yaml(file)); });
  read_or_refuse([&] { check(read_truth_camera(file)); });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
