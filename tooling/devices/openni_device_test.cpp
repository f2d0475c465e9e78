// SPDX-License-Identifier: Apache-2.0
// The driver against the library of OpenNI2: its own device without hardware, "Dummy", gives a
// pattern that is known. (Debian's library records .oni files, but plays none.)
#include "tooling/devices/openni_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/geometry/camera.hpp"
#include "tests/support/files.hpp"
#include "tooling/devices/open_device.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CameraModel elsewhere() {
  CameraModel camera;
  camera.depth_camera = std::make_shared<const DepthCamera>();
  return camera;
}

TEST(OpenNiDevice, GivesPairsOfNewImages) {
  if (!has_openni()) GTEST_SKIP() << "built without libopenni2-dev";
  const std::unique_ptr<Device> device = open_device("openni2:Dummy", {});
  EXPECT_EQ(device->name(), "openni2:Dummy");
  EXPECT_FALSE(device->camera());  // it tells no field of view
  EXPECT_THAT(device->warnings(), ElementsAre(HasSubstr("does not register its depth")));
  double last_s = -1;
  for (int i = 0; i < 5; ++i) {
    const std::optional<DeviceImages> images = device->wait(5);
    ASSERT_TRUE(images);
    EXPECT_GT(images->stamp_s, last_s);
    EXPECT_NEAR(images->stamp_s, images->depth_stamp_s, 0.02);
    last_s = images->stamp_s;
    EXPECT_EQ(images->color.mat.size(), cv::Size(320, 240));
    ASSERT_EQ(images->depth.mat.size(), cv::Size(320, 240));
  }
}

// Depth that the named camera brings into the view of colour is not to be registered twice.
TEST(OpenNiDevice, NeedNotRegister) {
  if (!has_openni()) GTEST_SKIP() << "built without libopenni2-dev";
  const std::unique_ptr<Device> device = open_device("openni2:Dummy", {.camera = elsewhere()});
  EXPECT_TRUE(device->warnings().empty());
  EXPECT_TRUE(device->wait(5));  // the driver of "Dummy" crashes when it is closed at once
}

TEST(OpenNiDevice, SaysWhatIsMissing) {
  const std::string error = error_of([] { (void)open_device("openni2:99", {}); });
  EXPECT_THAT(error, HasSubstr("openni2:99: "));
  EXPECT_THAT(error, HasSubstr(has_openni() ? "finds" : "install libopenni2-dev"));
  if (has_openni()) {
    EXPECT_THAT(error_of([] { (void)open_device("openni2:nothing-like-this", {}); }),
                HasSubstr("cannot be opened"));
    EXPECT_THAT(error_of([] { (void)open_device("openni2:", {}); }),
                HasSubstr("expected openni2:"));
  }
  EXPECT_EQ(error_of([] { (void)open_device("webcam", {}); }),
            "webcam: unknown device, expected openni2:NUMBER, v4l2:COLOR,DEPTH or "
            "stream:ws://HOST:PORT");
}

}  // namespace
}  // namespace stillmap
