// SPDX-License-Identifier: Apache-2.0
// `stillmap run` with --device and --save-recording, as far as that needs no camera.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/devices/openni_device.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

class SaveRecording : public Cli {
 protected:
  SaveRecording() { write_plane_sequence(folder_ / "wall", 60); }
};

// A part of the sequence, so that frames have other numbers in the recording.
TEST_F(SaveRecording, OfALiveRunRepeatsItToTheBit) {
  const Outcome live = run("run wall --out out --live --frames 20:50 --save-recording kept");
  ASSERT_EQ(live.exit_code, 0) << live.err;
  EXPECT_THAT(live.out, HasSubstr("recording   30 frames in kept"));
  const Outcome again = run("run kept --out again --live --replay out/live.jsonl");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply", "live.jsonl"}) {
    EXPECT_EQ(content(std::string("out/") + file), content(std::string("again/") + file)) << file;
  }
}

TEST_F(SaveRecording, IsRefusedWhereItDoesNotFit) {
  const std::string run = "run wall --out out ";
  expect_refused(run + "--save-recording kept", "add --live, or name a --device");
  expect_refused(run + "--live --save-recording out", "is the folder of --out");
  expect_refused(run + "--live --save-recording wall", "--save-recording wall: is not empty");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt"));
}

TEST_F(SaveRecording, DevicesAreNamedOrRefused) {
  expect_refused("run --out out", "name a SEQUENCE, or a camera with --device");
  expect_refused("run wall --out out --device openni2:0", "SEQUENCE excludes --device");
  expect_refused("run --out out --device webcam", "--device webcam: unknown device");
  expect_refused("run --out out --device openni2:0 --frames 1:5", "--device excludes --frames");
  expect_refused("run --out out --device openni2:0 --color-topic /rgb",
                 "--device openni2:0: has no topics");
  expect_refused("run --out out --device v4l2:/dev/none,/dev/none",
                 "--device v4l2:/dev/none,/dev/none: /dev/none cannot be opened");
  expect_refused("run --out out --device stream:rtsp://camera",
                 "--device stream:rtsp://camera: rtsp is not offered, as video codecs carry no");
  expect_refused("run --out out --device openni2:99",
                 has_openni() ? "--device openni2:99: OpenNI2 finds"
                              : "--device openni2:99: this build has no OpenNI2; install");
}

}  // namespace
}  // namespace stillmap
