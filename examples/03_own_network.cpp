// SPDX-License-Identifier: Apache-2.0
// A network of one's own: whatever finds people in an image is a Segmenter.
#include <cstdio>
#include <memory>

#include "examples/wall_camera.hpp"
#include "stillmap/perception/objects/object_finder.hpp"
#include "stillmap/system/system.hpp"

namespace {

class OwnNetwork final : public stillmap::Segmenter {
 public:
  [[nodiscard]] stillmap::FrameDetections segment(const stillmap::ColorImage& color,
                                                  const stillmap::Stamp& stamp) const override {
    // Here the network runs on `color`. This one sees a person in the same place always.
    const cv::Rect pixels(20, 40, 60, 180);
    cv::Mat1b ids(color.mat.size(), std::uint8_t{0});
    ids(pixels).setTo(1);  // the object's id
    return {stamp, {{1, "person", 0.9F, {20, 40, 80, 220}}}, stillmap::ObjectMask(ids)};
  }
};

}  // namespace

int main() {
  WallCamera camera;
  stillmap::ObjectFinder objects(std::make_shared<OwnNetwork>());
  stillmap::System slam({}, WallCamera::model());
  stillmap::FrameResult result;
  for (int i = 0; i < 30; ++i) {
    const stillmap::RgbdFrame frame = camera.grab();
    result = slam.process(frame, objects.find(frame));
  }
  for (const stillmap::ObjectState& object : result.objects) {
    std::printf("%s, track %u: %s, because: %s\n",
                object.class_name.c_str(),
                object.track.value,
                object.dynamic ? "dynamic" : "static",
                std::string(stillmap::reason_name(object.reason)).c_str());
  }
  const bool left_out = result.excluded.covers(100, 50) && !result.excluded.covers(100, 250);
  return result.objects.size() == 1 && result.objects[0].dynamic && left_out ? 0 : 1;
}
