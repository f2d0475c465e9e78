// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/floor_plane.hpp"

#include <gtest/gtest.h>

#include "tests/support/room.hpp"

namespace stillmap {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

TEST(FindFloor, FindsTheFloorAmongLargerWallsInTheFirstCamerasFrame) {
  TestRoom room;
  const Eigen::Isometry3d T_world_room = room.T_world_room();
  room.move(T_world_room);
  room.add_noise(0.01);
  const std::optional<FloorPlane> floor = find_floor(room.cloud.positions, room.poses);
  ASSERT_TRUE(floor.has_value());
  EXPECT_LT(degrees_between(floor->up, T_world_room.linear() * Eigen::Vector3d::UnitZ()), 0.2);
  EXPECT_NEAR(floor->height_m(Eigen::Vector3d::Zero()), 1.2, 0.005);  // the first camera
}

TEST(FindFloor, IsTheSameToTheBit) {
  TestRoom room;
  room.move(room.T_world_room());
  const std::optional<FloorPlane> one = find_floor(room.cloud.positions, room.poses);
  const std::optional<FloorPlane> two = find_floor(room.cloud.positions, room.poses);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->up, two->up);
  EXPECT_EQ(one->offset_m, two->offset_m);
}

TEST(FindFloor, TakesNoTableForTheFloor) {
  TestRoom room;
  // A table larger than what is seen of the floor.
  add_rectangle(room.cloud, {0, 0, 0.8}, {3, 0, 0}, {0, 4, 0});
  std::erase_if(room.cloud.positions,
                [](const Eigen::Vector3f& p) { return p.z() == 0 && p.x() > 1.2F; });
  const std::optional<FloorPlane> floor = find_floor(room.cloud.positions, room.poses);
  ASSERT_TRUE(floor.has_value());
  EXPECT_NEAR(floor->height_m({0, 0, 0}), 0.0, 0.005);
}

TEST(FindFloor, FindsNoneWhereThereIsNone) {
  TestRoom walls;
  std::erase_if(walls.cloud.positions, [](const Eigen::Vector3f& p) { return p.z() < 0.8F; });
  EXPECT_FALSE(find_floor(walls.cloud.positions, walls.poses).has_value());

  const TestRoom room;
  EXPECT_FALSE(find_floor({}, room.poses).has_value());
  EXPECT_FALSE(find_floor(room.cloud.positions, {}).has_value());
}

// The cameras are all that tells a floor from a wall.
TEST(FindFloor, TrustsThatCamerasAreAboutUpright) {
  for (const double roll_deg : {-40.0, 40.0, 180.0}) {
    TestRoom room;
    for (Eigen::Isometry3d& pose : room.poses) {
      pose.rotate(Eigen::AngleAxisd(roll_deg * M_PI / 180, Eigen::Vector3d::UnitZ()));
    }
    const std::optional<FloorPlane> floor = find_floor(room.cloud.positions, room.poses);
    EXPECT_EQ(floor.has_value(), roll_deg < 90);
    if (floor) {
      EXPECT_LT(degrees_between(floor->up, Eigen::Vector3d::UnitZ()), 0.2);
    }
  }
}

TEST(FloorFrame, HasItsOriginBelowTheCameraAndLooksWhereItLooks) {
  const FloorPlane floor{Eigen::Vector3d::UnitZ(), -0.5};  // at z = 0.5
  const Eigen::Isometry3d T = floor_frame(floor, looking({1, 2, 1.7}, 90, 30));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 2, 0.5)).isZero(1e-12));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 3, 0.5)).isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
  EXPECT_TRUE((T * Eigen::Vector3d(0, 2, 0.5)).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 2, 1.7)).isApprox(Eigen::Vector3d(0, 0, 1.2), 1e-12));
}

TEST(FloorFrame, OfACameraThatLooksStraightDown) {
  const FloorPlane floor{Eigen::Vector3d::UnitZ(), 0};
  const Eigen::Isometry3d T = floor_frame(floor, looking({0, 0, 1}, 0, 90));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
}

}  // namespace
}  // namespace stillmap
