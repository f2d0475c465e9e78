// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/trajectory_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Trajectory read(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "t.txt", text);
  return read_trajectory(folder.path() / "t.txt");
}

std::string error_for(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

TEST(ReadTrajectory, ReadsPosesWithCommentsBlanksAndWindowsLines) {
  const Trajectory poses = read(
      "# stamp tx ty tz qx qy qz qw\r\n\r\n"
      "  1305031102.175304\t1 2 3 0 0 0.7071 0.7071\r\n"
      "1305031102.2 -1e-3 0 0 0 0 0 1");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].stamp.text, "1305031102.175304");
  EXPECT_EQ(poses[0].stamp.seconds, 1305031102.175304);
  EXPECT_EQ(poses[0].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  // A quarter turn about z takes x to y; four decimals do not make it longer.
  const Eigen::Vector3d turned = poses[0].T_world_camera.linear() * Eigen::Vector3d(1, 0, 0);
  EXPECT_TRUE(turned.isApprox(Eigen::Vector3d(0, 1, 0), 1e-12)) << turned.transpose();
  EXPECT_EQ(poses[1].T_world_camera.translation().x(), -1e-3);
}

TEST(ReadTrajectory, SortsByStampAndLetsTheLastOfEqualStampsCount) {
  const Trajectory poses = read(
      "2.0 1 0 0 0 0 0 1\n"
      "1.0 2 0 0 0 0 0 1\n"
      "2.00 3 0 0 0 0 0 1\n"
      "3 4 0 0 0 0 0 1\n");
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].T_world_camera.translation().x(), 2.0);
  EXPECT_EQ(poses[1].T_world_camera.translation().x(), 3.0);
  EXPECT_EQ(poses[1].stamp.text, "2.00");
  EXPECT_EQ(poses[2].T_world_camera.translation().x(), 4.0);
}

TEST(ReadTrajectory, RefusesBadLinesWithTheirNumber) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(error_for(good + "2 0 0 0 0 0 0\n"),
              AllOf(HasSubstr("t.txt:2"), HasSubstr("7 columns, expected 8")));
  EXPECT_THAT(error_for(good + "2 0 0 0 0 0 0 1 9\n"), HasSubstr("t.txt:2: more columns"));
  EXPECT_THAT(error_for("#\n" + good + "2 0 nan 0 0 0 0 1\n"),
              AllOf(HasSubstr("t.txt:3"), HasSubstr("column 3 is 'nan'")));
  EXPECT_THAT(error_for(good + "2 0 0 inf 0 0 0 1\n"), HasSubstr("column 4"));
  EXPECT_THAT(error_for(good + "2 0 0 1e999 0 0 0 1\n"), HasSubstr("finite"));
  EXPECT_THAT(error_for(good + "2 0 0 0,5 0 0 0 1\n"), HasSubstr("'0,5'"));
  EXPECT_THAT(error_for(good + "nan 0 0 0 0 0 0 1\n"), HasSubstr("t.txt:2: column 1"));
  EXPECT_THAT(error_for(good + "2 0 0 0 0 0 0 0\n"),
              AllOf(HasSubstr("t.txt:2"), HasSubstr("quaternion of length 0")));
  EXPECT_THAT(error_for(good + "2 1e300 0 0 0 0 0 1\n"), HasSubstr("position"));
  EXPECT_THAT(error_for(good + "2 0 0 0 1e300 0 0 1\n"), HasSubstr("quaternion"));
  EXPECT_THAT(error_for(good + "2 \x01\x02 0 0 0 0 0 1\n"), HasSubstr("'?\?'"));
  EXPECT_THAT(error_for("# nothing\n"), HasSubstr("no poses"));
  EXPECT_THAT(error_for(std::string(1000000, '1')), HasSubstr("t.txt:1: 1 columns"));
}

TEST(FormatTrajectory, RepeatsStampsAndKeepsPosesTo1e7) {
  Trajectory poses;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 0.3 * i, -2).normalized();
    poses.push_back({{1000.5 + i, fmt::format("{}.5000", 1000 + i)},
                     make_pose(so3_exp(0.3 * i * axis), {0.1 * i, -1.0 / 3.0, 12345.678})});
  }
  const std::string text = format_trajectory(poses);
  const Trajectory read_back = read(text);
  ASSERT_EQ(read_back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(read_back[i].stamp.text, poses[i].stamp.text);
    const Eigen::Isometry3d difference =
        poses[i].T_world_camera.inverse() * read_back[i].T_world_camera;
    EXPECT_LT(difference.translation().norm(), 2e-7);
    EXPECT_LT(rotation_angle(difference.linear()), 5e-7);
  }
}

TEST(FormatTrajectory, IsTheTumFormat) {
  Trajectory poses(1);
  poses[0].stamp = {1.25, "1.250000"};
  poses[0].T_world_camera.translation() = Eigen::Vector3d(1, -2, 0.5);
  EXPECT_EQ(format_trajectory(poses),
            "1.250000 1.0000000 -2.0000000 0.5000000 0.0000000 0.0000000 0.0000000 1.0000000\n");
}

TEST(ReadTrajectory, ReadsThePublishedFiles) {
  STILLMAP_NEED_SHARED_DATA("trajectories");
  const std::filesystem::path folder = shared_data("trajectories");
  // 2484 lines of poses of which two have one stamp; two written late.
  EXPECT_EQ(read_trajectory(folder / "fr3_walking_static.groundtruth.txt").size(), 2483U);
  const Trajectory late = read_trajectory(folder / "fr3_walking_xyz.v3d-slam.txt");
  EXPECT_EQ(late.size(), 829U);
  for (std::size_t i = 1; i < late.size(); ++i) {
    ASSERT_LT(late[i - 1].stamp.seconds, late[i].stamp.seconds);
  }
}

}  // namespace
}  // namespace stillmap
