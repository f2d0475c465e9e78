// SPDX-License-Identifier: Apache-2.0
// Live runs on a device: through stalls and unplugging, kept as a recording, and made again.
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/sensor/arriving_stream.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/fake_device.hpp"
#include "tests/support/live_runs.hpp"
#include "tooling/devices/device_stream.hpp"
#include "tooling/devices/recording_stream.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

// A camera before the wall of live_runs.hpp. It gives nothing for some seconds after a third of the
// frames, and is plugged out and in again after two thirds: its clock begins anew.
std::deque<FakeDevice::Event> wall_events(double stall_s, double unplugged_s) {
  std::deque<FakeDevice::Event> events;
  double device_s = 20;
  for (std::uint32_t i = 0; i < kWallFrames; ++i) {
    double after_s = kWallPeriod_s;
    if (i == kWallFrames / 3) after_s += stall_s;
    device_s += after_s;
    if (i == 2 * kWallFrames / 3) {
      events.push_back({unplugged_s});
      device_s = 0;
    }
    const FramePtr frame = wall_sequence().read(FrameId(i));
    events.push_back({after_s, DeviceImages{device_s, device_s, frame->color, frame->depth}});
  }
  return events;
}

struct DeviceRun {
  SequenceRun run;
  std::vector<std::string> told;
};

// `folder`: for the recording. Frames come every 10 ms of real time: some are dropped.
DeviceRun run_on_device(std::deque<FakeDevice::Event> events,
                        const Segmenter* segmenter,
                        const std::filesystem::path& folder) {
  DeviceRun result;
  SharedClock clock;
  FakeDevice device(clock, std::move(events), wall_sequence().camera());
  DeviceStream frames(device,
                      clock,
                      {.camera = {},
                       .begin_s = 1000,
                       .stopped = [] { return false; },
                       .tell = [&](const std::string& line) { result.told.push_back(line); }});
  RecordingStream kept(frames, folder);
  RunOptions options;
  options.segmenter = segmenter;
  options.live.emplace();
  options.live->arriving = true;
  options.live->clock = &clock;
  options.probe = [](Stage stage) {
    if (stage == Stage::kReading) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  };
  result.run = run_sequence(kept, {}, std::move(options));
  kept.finish();
  return result;
}

SequenceRun run_again(const std::filesystem::path& folder,
                      const Segmenter* segmenter,
                      const LiveRecord& record) {
  RunOptions options;
  options.segmenter = segmenter;
  options.threads = 1;
  options.live.emplace();
  options.live->record = record;
  SequenceStream kept(Sequence::open(folder));
  return run_sequence(kept, {}, std::move(options));
}

TEST(DeviceRun, GoesOnAfterAStallAndAfterUnplugging) {
  const TemporaryFolder folder;
  const DeviceRun on_device = run_on_device(wall_events(5, 8), nullptr, folder.path() / "kept");
  const SequenceRun& run = on_device.run;
  ASSERT_EQ(on_device.told.size(), 4U);  // twice gone, twice back
  EXPECT_EQ(run.result.trajectory.size(), run.live_record.size());
  EXPECT_FALSE(run.result.lost_at_end);
  EXPECT_EQ(run.live_record.size() + run.report.live->dropped, kWallFrames);
  // The last frame is always taken: 58 mm to the right of the first, 29 mm lower.
  const Eigen::Vector3d way = run.result.trajectory.back().T_world_camera.translation() -
                              run.result.trajectory.front().T_world_camera.translation();
  const double first_m = 0.002 * run.live_record.front().frame.value;
  EXPECT_NEAR(way.x(), 0.058 - first_m, 0.01);
}

TEST(DeviceRun, OnItsRecordingHasTheSameBits) {
  for (const int network_ms : {0, 5}) {
    const TemporaryFolder folder;
    const StandInSegmenter segmenter{std::chrono::milliseconds(network_ms)};
    const DeviceRun on_device =
        run_on_device(wall_events(5, 8), &segmenter, folder.path() / "kept");
    EXPECT_EQ(Sequence::open(folder.path() / "kept").size(), kWallFrames);  // dropped ones, too
    expect_same(on_device.run,
                run_again(folder.path() / "kept", &segmenter, on_device.run.live_record));
  }
}

TEST(DeviceRun, EndsWithTheDevicesFailure) {
  const TemporaryFolder folder;
  std::deque<FakeDevice::Event> events = wall_events(0, 0);
  events.push_back({0.1, {}, "fake:0: burnt"});
  EXPECT_EQ(error_of([&] { (void)run_on_device(events, nullptr, folder.path() / "kept"); }),
            "fake:0: burnt");
}

// Frames that come while nobody takes them are dropped, but for the newest.
TEST(ArrivingStream, GivesTheNewestFrame) {
  SharedClock clock;
  SequenceStream wall(wall_sequence());
  ArrivingStream camera(wall, clock);
  std::size_t taken = 0;
  std::optional<FrameId> last;
  while (const std::optional<StreamedFrame> frame = camera.next()) {
    EXPECT_TRUE(!last || id_of(*frame) > *last);
    last = id_of(*frame);
    ++taken;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE(last);
  EXPECT_EQ(last->value, kWallFrames - 1);
  EXPECT_EQ(taken + camera.dropped(), kWallFrames);
  EXPECT_LT(taken, kWallFrames);
}

}  // namespace
}  // namespace stillmap
