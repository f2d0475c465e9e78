// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/occupancy_grid.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "tests/support/files.hpp"
#include "tests/support/room.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

char state(const OccupancyGrid& grid, double x, double y) {
  const Eigen::Array2d cell = ((Eigen::Vector2d(x, y) - grid.origin_m) / grid.resolution_m).array();
  if ((cell < 0).any() || cell.x() >= grid.width || cell.y() >= grid.height) return '?';
  const GridCell value =
      grid.at(static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y())));
  return value == GridCell::kOccupied ? '#' : value == GridCell::kFree ? '.' : '?';
}

OccupancyGrid grid_of(const TestRoom& room,
                      const SpaceOptions& options = {},
                      const HeightBand& band = {}) {
  return make_occupancy_grid(room.cloud.positions, room.poses, room.camera, options, band);
}

TEST(MakeOccupancyGrid, OfARoomWithATable) {
  const OccupancyGrid grid = grid_of(TestRoom());
  for (double y = 1.63; y < 2.4; y += 0.05) {
    for (double x = 1.53; x < 2.1; x += 0.05) EXPECT_EQ(state(grid, x, y), '#') << x << ' ' << y;
  }
  for (double x = 0.63; x < 1.45; x += 0.05) EXPECT_EQ(state(grid, x, 2.02), '.') << x;
  for (double x = 2.23; x < 3.0; x += 0.05) EXPECT_EQ(state(grid, x, 2.02), '.') << x;
  EXPECT_EQ(state(grid, 3.02, 2.02), '#');
  for (double x = 3.13; x < 4.95; x += 0.05) EXPECT_EQ(state(grid, x, 2.02), '?') << x;
  EXPECT_EQ(state(grid, 5.01, 2.02), '#');
  EXPECT_EQ(state(grid, 0.3, 5), '?');  // outside
}

TEST(MakeOccupancyGrid, TheFloorIsNoObstacleAtAnyResolution) {
  TestRoom room;
  room.add_noise(0.01);
  for (const double resolution : {0.02, 0.05, 0.07, 0.25}) {
    const OccupancyGrid grid = grid_of(room, {.resolution_m = resolution, .max_range_m = 6});
    EXPECT_EQ(state(grid, 1.0, 1.0), '.') << resolution;
    EXPECT_EQ(state(grid, 1.0, 3.0), '.') << resolution;
    EXPECT_EQ(state(grid, 1.8, 2.0), '#') << resolution;
  }
}

TEST(MakeOccupancyGrid, ATableHigherThanTheRobotIsNoObstacle) {
  EXPECT_EQ(state(grid_of(TestRoom(), {}, {0.1, 0.6}), 1.8, 2.0), '.');
  EXPECT_EQ(state(grid_of(TestRoom(), {}, {0.8, 1.8}), 1.8, 2.0), '.');
}

TEST(MakeOccupancyGrid, GroundHiddenByATableIsUnknownGroundNeverLookedAtFree) {
  TestRoom room;
  // Nothing of the floor behind the table is in the map, nor near the camera.
  std::erase_if(room.cloud.positions, [](const Eigen::Vector3f& p) {
    return p.z() < 0.1F && (p.x() > 1.2F || p.x() < 0.9F);
  });
  // The view below the table is blocked too.
  add_rectangle(room.cloud, {1.5, 1.6, 0}, {0, 0.8, 0}, {0, 0, 0.72});
  const OccupancyGrid grid = grid_of(room);
  EXPECT_EQ(state(grid, 2.32, 2.02), '?');  // in view, hidden; over it much is free
  EXPECT_EQ(state(grid, 0.87, 2.02), '.');  // below the image's lower edge
}

TEST(MakeOccupancyGrid, OneStrayPointIsNoObstacle) {
  TestRoom room;
  room.cloud.positions.emplace_back(0.83F, 1.03F, 1.0F);
  EXPECT_EQ(state(grid_of(room), 0.83, 1.03), '.');
  room.cloud.positions.emplace_back(0.83F, 1.03F, 0.7F);
  EXPECT_EQ(state(grid_of(room), 0.83, 1.03), '#');
}

TEST(MakeOccupancyGrid, OfNothingIsEmptyAndOfTooMuchAnError) {
  const TestRoom room;
  EXPECT_EQ(make_occupancy_grid({}, {}, room.camera, {}, {}).cells.size(), 0U);
  const std::vector<Eigen::Vector3f> wide = {{-900, -900, 1}, {900, 900, 1}};
  EXPECT_THAT(error_of([&] { (void)make_occupancy_grid(wide, {}, room.camera, {}, {}); }),
              HasSubstr("choose larger ones"));
}

OccupancyGrid three_by_two() {
  return {.width = 3,
          .height = 2,
          .resolution_m = 0.05,
          .origin_m = {-1.25, 0.1},
          .cells = {GridCell::kOccupied,
                    GridCell::kFree,
                    GridCell::kUnknown,
                    GridCell::kFree,
                    GridCell::kFree,
                    GridCell::kOccupied}};
}

TEST(EncodePgm, HasTheHighestYOnTop) {
  EXPECT_EQ(encode_pgm(three_by_two()), std::string("P5\n3 2\n255\n\xfe\xfe\x00\x00\xfe\xcd", 17));
}

TEST(FormatGridYaml, IsReadByAnotherParser) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.translation() = Eigen::Vector3d(0.5, -0.25, 1.2);
  const YAML::Node root = YAML::Load(format_grid_yaml(three_by_two(), "a \"b\\c: #1.pgm", T));
  EXPECT_EQ(root["image"].as<std::string>(), "a \"b\\c: #1.pgm");
  EXPECT_EQ(root["mode"].as<std::string>(), "trinary");
  EXPECT_EQ(root["resolution"].as<double>(), 0.05);
  EXPECT_EQ(root["origin"].as<std::vector<double>>(), (std::vector<double>{-1.25, 0.1, 0}));
  EXPECT_EQ(root["negate"].as<int>(), 0);
  EXPECT_EQ(root["T_grid_map"][0].as<std::vector<double>>(), (std::vector<double>{0, 0, 1, 0.5}));
  EXPECT_EQ(root["T_grid_map"][2].as<std::vector<double>>(), (std::vector<double>{0, -1, 0, 1.2}));
  // As map_server judges the three grays.
  const auto occupancy = [](int gray) { return (255 - gray) / 255.0; };
  EXPECT_GT(occupancy(0), root["occupied_thresh"].as<double>());
  EXPECT_LT(occupancy(254), root["free_thresh"].as<double>());
  EXPECT_GT(occupancy(205), root["free_thresh"].as<double>());
  EXPECT_LT(occupancy(205), root["occupied_thresh"].as<double>());
}

}  // namespace
}  // namespace stillmap
