// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/observed_space.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.hpp"
#include "tests/support/room.hpp"
#include "tooling/export/voxel_walk.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

// One voxel by its index; nullptr where nothing is known.
const SpaceVoxel* find(const ObservedSpace& space, const Eigen::Vector3i& index) {
  const auto at = std::ranges::find(space.voxels, index, &SpaceVoxel::index);
  return at == space.voxels.end() ? nullptr : &*at;
}

const SpaceVoxel* find_at(const ObservedSpace& space, const Eigen::Vector3d& p) {
  return find(space, voxel_of(p, space.resolution_m));
}

// A camera in voxel (0, 0, 0) looks along x at a point 1.02 m away, in voxel (20, 0, 0).
const std::vector<Eigen::Isometry3d> kTwice(2, looking({0.02, 0.02, 0.02}, 0, 0));
const std::vector<Eigen::Vector3f> kPoint = {{1.04F, 0.021F, 0.021F}};

TEST(ObserveSpace, IsFreeBeforeAPointOccupiedAtItUnknownBehind) {
  const ObservedSpace space = observe_space(kPoint, kTwice, test_camera(), {});
  ASSERT_EQ(space.voxels.size(), 21U);
  for (const SpaceVoxel& voxel : space.voxels) {
    EXPECT_EQ(voxel.index.tail<2>(), Eigen::Vector2i(0, 0));
    EXPECT_EQ(voxel.occupied(), voxel.index.x() == 20);
    EXPECT_EQ(voxel.points, voxel.index.x() == 20 ? 1 : 0);
    EXPECT_EQ(voxel.views, 2);
  }
}

TEST(ObserveSpace, IsFreeNoFartherThanTheRange) {
  const ObservedSpace space =
      observe_space(kPoint, kTwice, test_camera(), {.resolution_m = 0.05, .max_range_m = 0.5});
  ASSERT_NE(find(space, {10, 0, 0}), nullptr);
  EXPECT_EQ(find(space, {11, 0, 0}), nullptr);
  ASSERT_NE(find(space, {20, 0, 0}), nullptr);
  EXPECT_TRUE(find(space, {20, 0, 0})->occupied());
  EXPECT_EQ(find(space, {20, 0, 0})->views, 0);
}

TEST(ObserveSpace, PointsBehindTheCameraStayOccupied) {
  const std::vector<Eigen::Vector3f> behind = {{-1.02F, 0, 0}};
  const ObservedSpace space = observe_space(behind, kTwice, test_camera(), {});
  ASSERT_EQ(space.voxels.size(), 1U);
  EXPECT_TRUE(space.voxels.front().occupied());
}

TEST(ObserveSpace, OfARoomKnowsWhatIsFreeAndWhatIsHidden) {
  const TestRoom room;
  const ObservedSpace space = observe_space(room.cloud.positions, room.poses, room.camera, {});
  const auto state = [&](double x, double y, double z) {
    const SpaceVoxel* voxel = find_at(space, {x, y, z});
    return voxel == nullptr ? '?' : voxel->occupied() ? '#' : '.';
  };
  EXPECT_EQ(state(1.01, 2.01, 1.01), '.');  // between camera and wall
  EXPECT_EQ(state(2.96, 2.01, 1.22), '.');
  EXPECT_EQ(state(3.02, 2.01, 1.22), '#');  // the wall
  EXPECT_EQ(state(3.12, 2.01, 1.22), '?');  // behind it
  EXPECT_EQ(state(4.22, 2.01, 1.22), '?');
  EXPECT_EQ(state(5.01, 2.01, 1.22), '#');  // another room's wall
  EXPECT_EQ(state(1.82, 2.01, 0.72), '#');  // on the table
  EXPECT_EQ(state(1.82, 2.01, 0.82), '.');  // above it
  EXPECT_EQ(state(1.92, 2.01, 0.32), '.');  // below it, in view over the floor
  EXPECT_EQ(state(1.92, 2.01, 0.62), '?');  // below it, where no camera looks
}

TEST(ObserveSpace, NothingBehindAClosedWallIsFreeAtAnyAngle) {
  for (const double yaw : {0.0, 17.0, 31.0}) {
    TestRoom room;
    room.move(Eigen::Isometry3d(
        Eigen::AngleAxisd(yaw * M_PI / 180, Eigen::Vector3d(1, 2, 3).normalized())));
    const ObservedSpace space = observe_space(room.cloud.positions, room.poses, room.camera, {});
    const Eigen::Isometry3d T_room_world = TestRoom().poses.front() * room.poses.front().inverse();
    for (const SpaceVoxel& voxel : space.voxels) {
      if (voxel.occupied()) continue;
      const Eigen::Vector3d p =
          T_room_world * (0.05 * (voxel.index.cast<double>().array() + 0.5).matrix());
      ASSERT_LT(p.x(), 3.1);
      ASSERT_GT(p.z(), -0.1);
      ASSERT_TRUE(p.y() > -0.1 && p.y() < 4.1);
    }
  }
}

TEST(ObserveSpace, RefusesPointsTooFarOut) {
  const std::vector<Eigen::Vector3f> far = {{2000, 0, 0}};
  EXPECT_THAT(error_of([&] { (void)observe_space(far, kTwice, test_camera(), {}); }),
              HasSubstr("choose larger ones"));
}

}  // namespace
}  // namespace stillmap
