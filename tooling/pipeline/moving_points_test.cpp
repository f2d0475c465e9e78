// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/moving_points.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

CameraModel wide_camera() {
  CameraModel camera;
  camera.width_px = 60;
  camera.height_px = 30;
  camera.fx = camera.fy = 50;
  camera.cx = 30;
  camera.cy = 15;
  return camera;
}

RgbdFrame wall_at_2_m() {
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(30, 60, 2.0F));
  frame.depth.mat(0, 16) = 5;  // the mask's rim shows the room behind the walker
  frame.color = ColorImage(cv::Mat3b(30, 60, cv::Vec3b(1, 2, 3)));
  return frame;
}

/// A walker in the left third, a standing chair in the right third.
FrameResult seen(const Stamp& stamp, TrackId walker) {
  FrameResult result;
  result.stamp = stamp;
  result.status = TrackingStatus::kTracked;
  result.objects.resize(2);
  result.objects[0].track = walker;
  result.objects[0].dynamic = true;
  result.objects[1].track = TrackId(9);
  result.object_mask = ObjectMask(cv::Mat1b(30, 60, std::uint8_t{0}));
  result.object_mask.mat.colRange(0, 20).setTo(1);
  result.object_mask.mat.colRange(40, 60).setTo(2);
  return result;
}

struct Record {
  float x, y, z;
  std::uint8_t red, green, blue;
  std::int32_t track;
  double stamp;
};

Record record_at(const std::string& ply, std::size_t i) {
  constexpr std::size_t kBytes = 27;
  const char* at = ply.data() + ply.find("end_header\n") + 11 + i * kBytes;
  Record record{};
  std::memcpy(&record.x, at, 12);
  std::memcpy(&record.red, at + 12, 3);
  std::memcpy(&record.track, at + 15, 4);
  std::memcpy(&record.stamp, at + 19, 8);
  return record;
}

TEST(MovingPoints, AreThoseOfDynamicObjectsUnderFinalPoses) {
  MovingPoints movers(wide_camera());
  const Stamp early{5.0, "5.0"}, late{6.0, "6.0"}, elsewhere{7.0, "7.0"};
  movers.on_frame(wall_at_2_m(), seen(early, TrackId(3)));
  movers.on_frame(wall_at_2_m(), seen(late, TrackId(4)));
  movers.on_frame(wall_at_2_m(), seen(elsewhere, TrackId(4)));
  FrameResult lost = seen({8.0, "8.0"}, TrackId(4));
  lost.status = TrackingStatus::kLost;
  movers.on_frame(wall_at_2_m(), lost);
  RunResult end;
  end.united_tracks = {{TrackId(4), TrackId(3)}};  // 4 turned out to be 3
  movers.on_end(end);

  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation() << 10, 0, 0;
  const std::string ply = movers.ply({{early, Eigen::Isometry3d::Identity()}, {late, moved}});
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "movers.ply", ply);
  const PointCloud cloud = read_ply(folder.path() / "movers.ply");
  const std::size_t of_one = 5 * 8 - 1;  // every fourth of 20 columns and 30 rows, but the rim
  ASSERT_EQ(cloud.size(), 2 * of_one);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool second = i >= of_one;
    const Record record = record_at(ply, i);
    EXPECT_EQ(record.track, 3);
    EXPECT_EQ(record.stamp, second ? 6.0 : 5.0);
    EXPECT_EQ(record.blue, 3);
    EXPECT_FLOAT_EQ(record.z, 2);
    EXPECT_LT(record.x, (second ? 10.0F : 0.0F) - 0.4F);  // left of the camera
    EXPECT_GT(record.x, (second ? 10.0F : 0.0F) - 1.3F);
    EXPECT_EQ(cloud.positions[i].x(), record.x);
  }

  const std::vector<StampedGhosts> all = movers.ghosts(1000);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].stamp.text, "6.0");
  EXPECT_EQ(all[1].points.size(), of_one);
  EXPECT_EQ(all[1].points.positions[2], 32768 + 2000);
  EXPECT_EQ(all[1].points.colors[3], 0);  // the first of the frame's objects
  std::vector<std::size_t> few;
  for (const StampedGhosts& ghosts : movers.ghosts(12)) few.push_back(ghosts.points.size());
  EXPECT_EQ(few, (std::vector<std::size_t>{4, 4, 4}));
}

}  // namespace
}  // namespace stillmap
