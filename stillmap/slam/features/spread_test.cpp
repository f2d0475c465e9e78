// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/spread.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

using Corners = std::vector<cv::KeyPoint>;

// class_id is the place in the input.
cv::KeyPoint corner(float x, float y, float response, int id = 0) {
  return {cv::Point2f(x, y), 7.0F, -1.0F, response, 0, id};
}

// Most corners crowd in a corner of the image, where the strongest are too.
Corners crowded_corners(int count, std::uint32_t seed) {
  TestDice dice(seed);
  Corners corners;
  for (int i = 0; i < count; ++i) {
    const bool crowd = i % 10 != 0;
    const Eigen::Vector2f p = crowd ? dice.point(0, 120, 90) : dice.point(0, 639, 479);
    const auto strength = static_cast<float>(dice.integer(crowd ? 50 : 7, crowd ? 150 : 60));
    corners.push_back(corner(std::floor(p.x()), std::floor(p.y()), strength, i));
  }
  return corners;
}

Corners strongest(Corners corners, std::size_t count) {
  std::ranges::stable_sort(corners, [](auto& a, auto& b) { return a.response > b.response; });
  corners.resize(count);
  return corners;
}

std::size_t occupied_cells(const Corners& corners, float cell_px) {
  std::set<std::pair<int, int>> cells;
  for (const cv::KeyPoint& c : corners) {
    cells.insert({static_cast<int>(c.pt.x / cell_px), static_cast<int>(c.pt.y / cell_px)});
  }
  return cells.size();
}

std::set<int> ids(const Corners& corners) {
  std::set<int> all;
  for (const cv::KeyPoint& c : corners) all.insert(c.class_id);
  return all;
}

// The same quadtree, said plainly: a list of boxes, the fullest (of equals the oldest) is cut next.
Corners spread_plainly(const Corners& corners, std::size_t count) {
  struct Box {
    float x0, y0, x1, y1;
    Corners inside;
  };
  Box all{1e9F, 1e9F, -1e9F, -1e9F, corners};
  for (const cv::KeyPoint& c : corners) {
    all.x0 = std::min(all.x0, c.pt.x), all.x1 = std::max(all.x1, c.pt.x);
    all.y0 = std::min(all.y0, c.pt.y), all.y1 = std::max(all.y1, c.pt.y);
  }
  std::vector<Box> boxes = {all};
  while (boxes.size() < count) {
    const auto fullest = std::ranges::max_element(
        boxes, [](auto& a, auto& b) { return a.inside.size() < b.inside.size(); });
    if (fullest->inside.size() < 2) break;
    const Box box = *fullest;
    boxes.erase(fullest);
    const float xm = 0.5F * (box.x0 + box.x1), ym = 0.5F * (box.y0 + box.y1);
    std::vector<Box> children = {{box.x0, box.y0, xm, ym, {}},
                                 {xm, box.y0, box.x1, ym, {}},
                                 {box.x0, ym, xm, box.y1, {}},
                                 {xm, ym, box.x1, box.y1, {}}};
    for (const cv::KeyPoint& c : box.inside) {
      children[(c.pt.y < ym ? 0U : 2U) + (c.pt.x < xm ? 0U : 1U)].inside.push_back(c);
    }
    for (const Box& child : children) {
      if (!child.inside.empty()) boxes.push_back(child);
    }
  }
  Corners kept;
  for (const Box& box : boxes) kept.push_back(strongest(box.inside, 1).front());
  return kept;
}

TEST(SpreadEvenly, EqualsThePlainQuadtree) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const Corners corners = crowded_corners(100 + 40 * static_cast<int>(seed), seed);
    std::set<std::pair<float, float>> places;  // the plain version wants distinct ones
    Corners distinct;
    for (const cv::KeyPoint& c : corners) {
      if (places.insert({c.pt.x, c.pt.y}).second) distinct.push_back(c);
    }
    for (const int count : {1, 2, 7, 50, 90}) {
      EXPECT_EQ(ids(spread_evenly(distinct, count)),
                ids(spread_plainly(distinct, static_cast<std::size_t>(count))));
    }
  }
}

TEST(SpreadEvenly, ReturnsTheCountAtMostThreeMoreAndEachCornerOnce) {
  for (const int count : {1, 2, 3, 10, 100, 333}) {
    const Corners kept = spread_evenly(crowded_corners(2000, 3), count);
    EXPECT_GE(std::ssize(kept), count);
    EXPECT_LE(std::ssize(kept), count + 3);
    EXPECT_EQ(std::ssize(ids(kept)), std::ssize(kept));
  }
}

TEST(SpreadEvenly, FewCornersAreAllKeptAndNoneWhereNoneIsWanted) {
  const Corners corners = crowded_corners(20, 4);
  EXPECT_EQ(ids(spread_evenly(corners, 20)), ids(corners));
  EXPECT_EQ(ids(spread_evenly(corners, 1000)), ids(corners));
  EXPECT_TRUE(spread_evenly(corners, 0).empty());
  EXPECT_TRUE(spread_evenly(corners, -5).empty());
  EXPECT_TRUE(spread_evenly({}, 10).empty());
}

TEST(SpreadEvenly, StrongestOfARegionWinsAndOfEqualsTheEarlier) {
  // Four far quarters of three corners each.
  Corners corners;
  for (const auto& [x, y] :
       {std::pair{0.0F, 0.0F}, {600.0F, 0.0F}, {0.0F, 400.0F}, {600.0F, 400.0F}}) {
    const int id = static_cast<int>(corners.size());
    corners.push_back(corner(x, y, 10, id));
    corners.push_back(corner(x + 5, y + 5, 30, id + 1));
    corners.push_back(corner(x + 2, y + 9, 30, id + 2));
  }
  EXPECT_EQ(ids(spread_evenly(corners, 4)), (std::set<int>{1, 4, 7, 10}));
}

TEST(SpreadEvenly, SpreadsBetterThanTheStrongest) {
  const Corners corners = crowded_corners(2000, 5);
  const Corners kept = spread_evenly(corners, 150);
  EXPECT_GT(occupied_cells(kept, 40), 2 * occupied_cells(strongest(corners, kept.size()), 40));
}

TEST(SpreadEvenly, AllCornersOnOneSpotGiveItsStrongest) {
  Corners corners;
  for (int i = 0; i < 50; ++i) corners.push_back(corner(33, 44, static_cast<float>(i % 40), i));
  EXPECT_EQ(ids(spread_evenly(corners, 10)), (std::set<int>{39}));
}

// A crowd on one spot must not keep the others from being told apart.
TEST(SpreadEvenly, ACrowdOnOneSpotCountsAsOneCorner) {
  Corners corners;
  for (int i = 0; i < 50; ++i) corners.push_back(corner(30, 40, 5, i));
  for (int i = 50; i < 70; ++i) {
    corners.push_back(corner(static_cast<float>(10 * i % 170), static_cast<float>(i), 5, i));
  }
  std::set<int> expected = {0};
  for (int i = 50; i < 70; ++i) expected.insert(i);
  EXPECT_EQ(ids(spread_evenly(corners, 30)), expected);
}

TEST(SpreadEvenly, SpotsBetweenPixelsEndToo) {
  // Neighbouring numbers whose middle rounds up, and corners that differ in the last bit.
  const float odd = std::nextafter(100.0F, 200.0F), even = std::nextafter(odd, 200.0F);
  Corners corners;
  for (int i = 0; i < 40; ++i) corners.push_back(corner(i % 2 == 0 ? odd : even, odd, 5, i));
  corners.push_back(corner(0, 0, 5, 40));
  corners.push_back(corner(639, 479, 5, 41));
  EXPECT_EQ(ids(spread_evenly(corners, 10)), (std::set<int>{0, 1, 40, 41}));
}

}  // namespace
}  // namespace stillmap
