// SPDX-License-Identifier: Apache-2.0
// The map while the robot runs: an observer is given it every twenty frames.
#include <cstdio>

#include "examples/wall_camera.hpp"
#include "stillmap/system/system.hpp"

namespace {

class MapViewer final : public stillmap::Observer {
 public:
  void on_frame(const stillmap::RgbdFrame& /*frame*/,
                const stillmap::FrameResult& result) override {
    tracked_ += stillmap::has_pose(result) ? 1 : 0;
  }
  void on_map(const stillmap::PointCloud& map, std::int64_t frames) override {
    std::printf("after %lld frames, %d tracked: %zu points\n",
                static_cast<long long>(frames),
                tracked_,
                map.size());
    ++maps_;
  }
  [[nodiscard]] int maps() const { return maps_; }

 private:
  int tracked_ = 0, maps_ = 0;
};

}  // namespace

int main() {
  WallCamera camera;
  MapViewer viewer;
  stillmap::System slam(stillmap::Settings().set("dynamics.mode", "off"),
                        WallCamera::model(),
                        {.threads = 2, .snapshot_every_frames = 20, .observers = {&viewer}});
  for (int i = 0; i < 60; ++i) slam.process(camera.grab());
  const stillmap::PointCloud so_far = slam.map_snapshot();  // or whenever it is asked for
  const stillmap::RunResult run = slam.finish();
  const bool same = so_far.positions == run.map.positions;
  return viewer.maps() == 4 && same && !run.map.empty() ? 0 : 1;
}
