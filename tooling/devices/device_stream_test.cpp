// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/device_stream.hpp"

#include <deque>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"
#include "tests/support/fake_device.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CameraModel small_camera() {
  CameraModel camera;
  camera.name = "small";
  camera.width_px = 8;
  camera.height_px = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 3.5;
  camera.cy = 2.5;
  return camera;
}

FakeDevice::Event images_at(double after_s, double stamp_s, cv::Size size = {8, 6}) {
  const cv::Mat3b color(size, cv::Vec3b(1, 2, 3));
  return {after_s,
          DeviceImages{stamp_s, stamp_s, ColorImage(color), DepthImage(cv::Mat1f(size, 2.F))}};
}

/// A stream of a fake device, with what was told and when.
struct Watched {
  SharedClock clock;
  FakeDevice device;
  std::vector<std::string> told;
  std::vector<double> told_at_s;
  bool stopped = false;
  DeviceStream stream;

  explicit Watched(std::deque<FakeDevice::Event> events,
                   std::optional<CameraModel> camera = small_camera(),
                   std::optional<CameraModel> named = {})
      : device(clock, std::move(events), std::move(camera)),
        stream(device,
               clock,
               {.camera = std::move(named),
                .begin_s = 1000,
                .stopped = [this] { return stopped; },
                .tell =
                    [this](const std::string& line) {
                      told.push_back(line);
                      told_at_s.push_back(clock.now_s());
                    }}) {}

  std::vector<StreamedFrame> all() {
    std::vector<StreamedFrame> frames;
    while (std::optional<StreamedFrame> frame = stream.next()) frames.push_back(*frame);
    return frames;
  }
};

std::vector<double> stamps_of(const std::vector<StreamedFrame>& frames) {
  std::vector<double> stamps;
  for (const StreamedFrame& frame : frames) stamps.push_back(stamp_of(frame).seconds);
  return stamps;
}

MATCHER_P(Near, value, "") {
  return std::abs(arg - value) < 1e-9;
}

TEST(DeviceStream, GivesFramesByTheDevicesClock) {
  // The images come late and early by some milliseconds: that does not matter.
  Watched w({images_at(0.2, 7.0), images_at(0.04, 7.033), images_at(0.02, 7.066)});
  const std::vector<StreamedFrame> frames = w.all();
  EXPECT_THAT(stamps_of(frames), ElementsAre(Near(1000), Near(1000.033), Near(1000.066)));
  for (std::uint32_t i = 0; i < frames.size(); ++i) {
    const RgbdFrame& frame = *std::get<FramePtr>(frames[i]);
    EXPECT_EQ(frame.id, FrameId(i));
    EXPECT_EQ(frame.color.mat(1, 1), cv::Vec3b(1, 2, 3));
    EXPECT_EQ(frame.depth.mat(1, 1), 2.F);
    EXPECT_NEAR(frame.depth_stamp_s, frame.stamp.seconds, 1e-9);
  }
  EXPECT_TRUE(w.told.empty());
  EXPECT_TRUE(w.stream.warnings().empty());
}

TEST(DeviceStream, TellsWithinTwoSecondsThatImagesStayOutAndWaits) {
  Watched w({images_at(0, 1), images_at(9, 10), images_at(0.5, 10.5)});
  ASSERT_TRUE(w.stream.next());
  const double begin_s = w.clock.now_s();
  EXPECT_THAT(stamps_of(w.all()), ElementsAre(Near(1009), Near(1009.5)));
  ASSERT_EQ(w.told.size(), 2U);
  EXPECT_THAT(w.told[0], HasSubstr("fake:0 gives no images"));
  EXPECT_LE(w.told_at_s[0] - begin_s, 2);
  EXPECT_EQ(w.told[1], "fake:0 gives images again, after 9.0 s");
  EXPECT_THAT(w.stream.warnings(), ElementsAre("fake:0 gave no images 1 times, for 9.0 s in all"));
}

// After it was plugged in again a device counts from zero.
TEST(DeviceStream, StampsGoOnWhenTheDeviceBeginsAnew) {
  Watched w({images_at(0, 100), {3, {}, ""}, images_at(2, 0.01), images_at(0.1, 0.11)});
  EXPECT_THAT(stamps_of(w.all()), ElementsAre(Near(1000), Near(1005), Near(1005.1)));
  EXPECT_EQ(w.told.size(), 2U);
}

TEST(DeviceStream, ImagesOfAnotherSizeAreDamagedFrames) {
  Watched w({images_at(0, 1), images_at(0.1, 1.1, {4, 3}), images_at(0.1, 1.2)});
  const std::vector<StreamedFrame> frames = w.all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(std::get<DamagedFrame>(frames[1]).damage, "fake:0: colour of 4x3 pixels, expected 8x6");
  EXPECT_EQ(id_of(frames[2]), FrameId(2));
}

TEST(DeviceStream, LeavesImagesOutThatRepeatAStamp) {
  Watched w({images_at(0, 1), images_at(0.03, 1), images_at(0.03, 1.06)});
  EXPECT_THAT(stamps_of(w.all()), ElementsAre(Near(1000), Near(1000.06)));
  EXPECT_THAT(w.stream.warnings(), ElementsAre(HasSubstr("1 images repeat the stamp")));
}

TEST(DeviceStream, EndsWhenItIsStoppedEvenWhileImagesStayOut) {
  Watched w({images_at(0, 1)});
  w.device.go_on();
  ASSERT_TRUE(w.stream.next());
  DeviceStream stopping(w.device,
                        w.clock,
                        {.camera = {},
                         .begin_s = 0,
                         .stopped = [&] { return w.clock.now_s() > 530; },
                         .tell = [](const std::string&) {}});
  EXPECT_FALSE(stopping.next());
  EXPECT_LT(w.clock.now_s(), 531);
}

TEST(DeviceStream, PassesOnThatTheDeviceHasFailedForGood) {
  Watched w({images_at(0, 1), {0.1, {}, "fake:0: burnt"}});
  ASSERT_TRUE(w.stream.next());
  EXPECT_EQ(error_of([&] { (void)w.stream.next(); }), "fake:0: burnt");
}

TEST(DeviceStream, NeedsACamera) {
  EXPECT_EQ(error_of([] { Watched w({}, std::nullopt); }),
            "fake:0 does not tell its camera: name it with --camera");
}

// A named camera says where the depth camera is: half as many pixels over the same field of view.
TEST(DeviceStream, RegistersTheDepthOfACameraOfItsOwn) {
  CameraModel depth = small_camera();
  depth.width_px = 4;
  depth.height_px = 3;
  depth.fx = depth.fy = 5;
  depth.cx = 1.5;
  depth.cy = 1;
  CameraModel named = small_camera();
  named.depth_camera = std::make_shared<const DepthCamera>(DepthCamera{depth});
  FakeDevice::Event event = images_at(0, 1);
  event.images->depth = DepthImage(cv::Mat1f(3, 4, 1.5F));
  Watched w({event}, small_camera(), named);
  const std::vector<StreamedFrame> frames = w.all();
  ASSERT_EQ(frames.size(), 1U);
  const cv::Mat1f& seen = std::get<FramePtr>(frames[0])->depth.mat;
  ASSERT_EQ(seen.size(), cv::Size(8, 6));
  EXPECT_NEAR(seen(3, 4), 1.5F, 1e-6);
}

}  // namespace
}  // namespace stillmap
