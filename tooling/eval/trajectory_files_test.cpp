// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/trajectory_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

ReadTrajectory read(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "poses", text);
  return read_any_trajectory(folder.path() / "poses");
}

std::string error_for(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

// A quarter turn about z takes x to y; this pose also moves by (1, 2, 3).
void expect_quarter_turn(const Eigen::Isometry3d& T) {
  EXPECT_LT((T * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-7);
  EXPECT_LT((T * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1, 2, 4)).norm(), 1e-7);
}

TEST(ReadAnyTrajectory, ReadsTum) {
  const ReadTrajectory tum = read("# t\n1.5 1 2 3 0 0 0.70710678 0.70710678\n0.5 0 0 0 0 0 0 1\n");
  ASSERT_EQ(tum.poses.size(), 2U);
  EXPECT_EQ(tum.poses[1].stamp.text, "1.5");
  expect_quarter_turn(tum.poses[1].T_world_camera);
  EXPECT_EQ(tum.equal_stamps, 0U);
}

TEST(ReadAnyTrajectory, ReadsEuroc) {
  const ReadTrajectory euroc = read(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], ...\r\n"
      "1403636580838555648,1,2,3,0.70710678,0,0,0.70710678,0.1,0.2,0.3,0,0,0,0,0,0\r\n"
      "1403636580843555328, 4,5,6, 1,0,0,0\r\n");
  ASSERT_EQ(euroc.poses.size(), 2U);
  EXPECT_EQ(euroc.poses[0].stamp.text, "1403636580.838555648");
  EXPECT_NEAR(euroc.poses[0].stamp.seconds, 1403636580.838555648, 1e-6);
  expect_quarter_turn(euroc.poses[0].T_world_camera);
  EXPECT_EQ(euroc.poses[1].T_world_camera.translation(), Eigen::Vector3d(4, 5, 6));
}

TEST(ReadAnyTrajectory, ReadsKitti) {
  const ReadTrajectory kitti = read(
      "1 0 0 0 0 1 0 0 0 0 1 0\n"
      "0.000000e+00 -1 0 1 1 0 0 2 0 0 1 3\n");
  ASSERT_EQ(kitti.poses.size(), 2U);
  EXPECT_EQ(kitti.poses[1].stamp.seconds, 0.1);
  EXPECT_EQ(kitti.poses[1].stamp.text, "0.1");
  expect_quarter_turn(kitti.poses[1].T_world_camera);
}

TEST(ReadAnyTrajectory, CountsWhatALaterLineReplaces) {
  const ReadTrajectory tum =
      read("1.0 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n1.00 3 0 0 0 0 0 1\n1 4 0 0 0 0 0 1\n");
  EXPECT_EQ(tum.poses.size(), 2U);
  EXPECT_EQ(tum.equal_stamps, 2U);
  EXPECT_EQ(tum.poses[0].T_world_camera.translation().x(), 4);
  const ReadTrajectory euroc = read("7,1,0,0,1,0,0,0\n7,2,0,0,1,0,0,0\n");
  EXPECT_EQ(euroc.poses.size(), 1U);
  EXPECT_EQ(euroc.equal_stamps, 1U);
  EXPECT_EQ(euroc.poses[0].T_world_camera.translation().x(), 2);
}

TEST(ReadAnyTrajectory, RefusesWhatIsNone) {
  EXPECT_THAT(error_for(""), HasSubstr("no poses"));
  EXPECT_THAT(error_for("1,2,3\n"), AllOf(HasSubstr("poses:1: 3 columns"), HasSubstr("qw,qx")));
  EXPECT_THAT(error_for("#\n1,2,3,4,1,0,0,zero\n"), HasSubstr("poses:2: 'zero'"));
  EXPECT_THAT(error_for("1.5,2,3,4,1,0,0,0\n"), HasSubstr("'1.5'"));
  EXPECT_THAT(error_for("1,2,3,4,0,0,0,0\n"), HasSubstr("quaternion"));
  EXPECT_THAT(error_for("1,2e9,3,4,1,0,0,0\n"), HasSubstr("beyond"));
  EXPECT_THAT(error_for("1 0 0 0 0 1 0 0 0 0 2 0\n"), HasSubstr("poses:1: no rotation"));
  EXPECT_THAT(error_for("1 0 0 0 0 1 0 0 0 0 1 0\n1 2\n"), HasSubstr("poses:2: 2 columns"));
  EXPECT_THAT(error_for("1 2 3\n"), HasSubstr("3 columns, expected 8"));
}

}  // namespace
}  // namespace stillmap
