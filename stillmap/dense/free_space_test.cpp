// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/global_cloud.hpp"
#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/geometry/se3.hpp"
#include "tests/support/cameras.hpp"

namespace stillmap {
namespace {

CameraModel camera() {
  return centered_camera(160, 120, 130);
}

/// A thing whose front, at depth z, fills these pixels of a camera at the origin.
struct FlatThing {
  cv::Rect pixels;
  float z;
  Rgb color;
};

const Rgb kWall{200, 200, 200}, kChair{0, 0, 250}, kPerson{250, 0, 0};
const FlatThing kStandingPerson{{60, 20, 30, 80}, 1.5F, kPerson};

/// What a camera at the origin sees of a wall at 3 m and things before it. Where `masked` has
/// pixels a network has found somebody.
class Scene {
 public:
  void look(const std::vector<FlatThing>& things, const cv::Rect& masked = {}) {
    cv::Mat1f depth(120, 160, 3.0F);
    ColorImage color(cv::Mat3b(120, 160, cv::Vec3b(200, 200, 200)));
    for (const FlatThing& thing : things) {
      depth(thing.pixels).setTo(thing.z);
      color.mat(thing.pixels).setTo(cv::Scalar(thing.color[0], thing.color[1], thing.color[2]));
    }
    cv::Mat1b moving(depth.size(), std::uint8_t{0});
    moving(masked).setTo(1);
    cv::Mat1f still = depth.clone();
    still.setTo(0, moving);
    clouds_.push_back(compact(local_cloud(still, color, pixel_rays(camera()), {})));
    ranges_.push_back(range_image(depth, {Mask(moving), Mask(moving)}, {}));
  }

  /// How many points of each colour the map has with and without the check.
  [[nodiscard]] std::size_t count(const Rgb& color, bool checked) const {
    std::vector<PosedCloud> clouds;
    std::vector<PosedRange> ranges;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      clouds.push_back({Eigen::Isometry3d::Identity(), &clouds_[i]});
      ranges.push_back({Eigen::Isometry3d::Identity(), &ranges_[i]});
    }
    PointCloud map = global_cloud(clouds, 0.02);
    if (checked) map = without_moved(map, ranges, camera(), {});
    return static_cast<std::size_t>(std::ranges::count(map.colors, color));
  }

 private:
  std::vector<CompactCloud> clouds_;
  std::vector<RangeImage> ranges_;
};

TEST(FreeSpace, WhatGoesAwayLeavesTheMap) {
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.look({kStandingPerson});  // unnoticed by any network
  for (int i = 0; i < 6; ++i) scene.look({});
  EXPECT_GT(scene.count(kPerson, false), 500U);
  EXPECT_EQ(scene.count(kPerson, true), 0U);
  // The wall behind, which only the last views have seen, is there as a whole.
  EXPECT_EQ(scene.count(kWall, true), scene.count(kWall, false));
  EXPECT_GT(scene.count(kWall, true), 10000U);
}

TEST(FreeSpace, WhatNobodySeesThroughStays) {
  Scene scene;
  const FlatThing lamp{{10, 10, 20, 60}, 2.0F, {250, 250, 0}};
  for (int i = 0; i < 8; ++i) scene.look({lamp, kStandingPerson}, kStandingPerson.pixels);
  EXPECT_EQ(scene.count(kPerson, false), 0U);
  EXPECT_EQ(scene.count(lamp.color, true), scene.count(lamp.color, false));
  EXPECT_EQ(scene.count(kWall, true), scene.count(kWall, false));
}

TEST(FreeSpace, AMovedChairIsThereOnceAtItsLastPlace) {
  Scene scene;
  const FlatThing before{{20, 60, 30, 30}, 2.0F, kChair};
  const FlatThing after{{100, 60, 30, 30}, 2.0F, {0, 0, 251}};
  for (int i = 0; i < 12; ++i) scene.look({before});
  for (int i = 0; i < 6; ++i) scene.look({after});
  EXPECT_GT(scene.count(before.color, false), 100U);
  EXPECT_EQ(scene.count(before.color, true), 0U);
  EXPECT_EQ(scene.count(after.color, true), scene.count(after.color, false));
  EXPECT_GT(scene.count(after.color, true), 100U);
}

TEST(FreeSpace, OneViewThatSeesThroughIsNotEnough) {
  Scene scene;
  const FlatThing chair{{20, 60, 30, 30}, 2.0F, kChair};
  for (int i = 0; i < 12; ++i) scene.look({chair});
  scene.look({});  // a wrong pose, say
  EXPECT_EQ(scene.count(kChair, true), scene.count(kChair, false));
}

TEST(FreeSpace, WhatIsMostlyKnownToMoveGoesThoughNobodySeesThrough) {
  Scene scene;
  for (int i = 0; i < 9; ++i) scene.look({kStandingPerson}, kStandingPerson.pixels);
  for (int i = 0; i < 4; ++i) scene.look({kStandingPerson});  // missed by the network
  EXPECT_GT(scene.count(kPerson, false), 500U);
  EXPECT_EQ(scene.count(kPerson, true), 0U);
  EXPECT_EQ(scene.count(kWall, true), scene.count(kWall, false));
}

TEST(FreeSpace, ALimbThatOneMaskHasMissedGoes) {
  Scene scene;
  const FlatThing far_box{{130, 30, 20, 20}, 1.5F, {0, 250, 0}};  // alike, but away from anybody
  const cv::Rect body(60, 20, 24, 80);                            // without the right 6 columns
  scene.look({kStandingPerson, far_box}, body);
  EXPECT_GT(scene.count(kPerson, false), 100U);
  EXPECT_EQ(scene.count(kPerson, true), 0U);
  EXPECT_EQ(scene.count(far_box.color, true), scene.count(far_box.color, false));
}

TEST(FreeSpace, WhatIsSeenOnceWithoutAnybodyBesideItStays) {
  Scene scene;
  const FlatThing lamp{{90, 30, 20, 20}, 1.6F, {0, 250, 0}};
  scene.look({kStandingPerson, lamp}, kStandingPerson.pixels);  // somebody beside it
  EXPECT_EQ(scene.count(lamp.color, true), 0U);
  scene.look({lamp});  // nobody
  EXPECT_EQ(scene.count(lamp.color, true), scene.count(lamp.color, false));
  EXPECT_GT(scene.count(lamp.color, true), 100U);
}

/// The counts of one point, from the definition.
Sightings brute_force_sightings(const Eigen::Vector3f& point,
                                std::span<const PosedRange> keyframes,
                                const CameraModel& c) {
  const FreeSpaceConfig config;
  Sightings s;
  for (const PosedRange& k : keyframes) {
    const Eigen::Vector3d p = k.T_world_camera.inverse() * point.cast<double>();
    if (p.z() <= 0.05) continue;
    const Eigen::Vector2d px = c.distort(c.project(p));
    const int u = static_cast<int>(std::lround(px.x())), v = static_cast<int>(std::lround(px.y()));
    if (u < 0 || v < 0 || u >= c.width_px || v >= c.height_px) continue;
    const RangeCell cell = k.range->at(v / k.range->block_px, u / k.range->block_px);
    if (!cell.known()) continue;
    const double behind = static_cast<double>(cell.range_m()) - p.z();
    const double margin = config.margin_m + config.margin_per_m * p.z() * p.z();
    if (cell.moving()) {
      s.moving = static_cast<std::uint8_t>(s.moving + (std::abs(behind) <= margin ? 1 : 0));
    } else if (behind > margin) {
      ++s.through;
      ++s.through_last;
      s.seen_last = 0;
    } else if (behind >= -margin) {
      ++s.seen;
      ++s.seen_last;
      s.through_last = 0;
    }
  }
  return s;
}

void expect_agreement_with_brute_force(const CameraModel& c) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<RangeImage> ranges;
  std::vector<PosedRange> keyframes;
  for (int i = 0; i < 12; ++i) {
    cv::Mat1f depth(120, 160);
    for (float& z : depth) z = static_cast<float>(2 + 0.4 * unit(rng) * unit(rng));
    depth(cv::Rect(5 * i, 40, 20, 20)).setTo(0);
    cv::Mat1b moving(depth.size(), std::uint8_t{0});
    moving(cv::Rect(100 - 5 * i, 10, 40, 80)).setTo(1);
    ranges.push_back(range_image(depth, {Mask(moving), Mask(moving)}, {}));
  }
  for (const RangeImage& range : ranges) {
    const Eigen::Vector3d turn(unit(rng), unit(rng), unit(rng)), shift(unit(rng), unit(rng), 0);
    keyframes.push_back({make_pose(so3_exp(0.3 * turn), 0.3 * shift), &range});
  }
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 3000; ++i) {
    points.emplace_back(
        Eigen::Vector3d(1.5 * unit(rng), unit(rng), 2 + 0.5 * unit(rng)).cast<float>());
  }
  points.emplace_back(0.0F, 0.0F, -1.0F);  // behind all
  const std::vector<Sightings> all = sightings(points, keyframes, c, {});
  int different = 0;
  std::set<int> seen, through, moving;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Sightings s = brute_force_sightings(points[i], keyframes, c);
    // Single precision may put a point on the pixel beside.
    different += s.seen != all[i].seen || s.through != all[i].through ||
                 s.moving != all[i].moving || s.seen_last != all[i].seen_last ||
                 s.through_last != all[i].through_last;
    seen.insert(s.seen);
    through.insert(s.through);
    moving.insert(s.moving);
  }
  EXPECT_LT(different, 3);
  EXPECT_GT(seen.size(), 4U);
  EXPECT_GT(through.size(), 4U);
  EXPECT_GT(moving.size(), 2U);

  const auto numbers = [](const Sightings& s) {
    return std::array{s.seen, s.moving, s.beside, s.through, s.seen_last, s.through_last};
  };
  for (const std::size_t threads : {2U, 3U, 20U}) {
    const std::vector<Sightings> several = sightings(points, keyframes, c, {}, threads);
    ASSERT_EQ(several.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(numbers(several[i]), numbers(all[i])) << i << " with " << threads << " threads";
    }
  }
}

TEST(FreeSpace, SightingsAgreeWithBruteForce) {
  CameraModel c = camera();
  c.k1 = 0.1;
  c.k2 = 0.02;
  c.p1 = 0.001;
  expect_agreement_with_brute_force(c);
}

TEST(FreeSpace, SightingsOfWideLensesAgreeWithBruteForce) {
  CameraModel rational = camera();
  rational.k1 = 0.5, rational.k2 = 0.1, rational.k4 = 0.8, rational.k5 = 0.3, rational.k6 = 0.02;
  expect_agreement_with_brute_force(rational);
  CameraModel fisheye = camera();
  fisheye.lens = LensModel::kFisheye;
  fisheye.fx *= 0.6;
  fisheye.fy *= 0.6;
  fisheye.k1 = 0.02;
  fisheye.k3 = -0.01;
  expect_agreement_with_brute_force(fisheye);
}

TEST(FreeSpace, ADistortionThatFoldsBackShowsNothingFromOutside) {
  CameraModel c = camera();
  c.k1 = -0.3;  // at a slope of 1.8, the polynomial is back in the middle of the image
  const RangeImage range = range_image(cv::Mat1f(120, 160, 3.0F), {}, {});
  const std::vector<PosedRange> keyframes{{Eigen::Isometry3d::Identity(), &range}};
  const std::vector<Eigen::Vector3f> points{{1.8F, 0, 1}, {0.2F, 0, 1}};
  const std::vector<Sightings> all = sightings(points, keyframes, c, {});
  EXPECT_EQ(all[0].through, 0);
  EXPECT_EQ(all[1].through, 1);
}

TEST(FreeSpace, StaysOrGoes) {
  const FreeSpaceConfig config{.min_through = 2,
                               .min_stay = 5,
                               .max_through_share = 0.25,
                               .max_moving_share = 2.0,
                               .weakly_seen = 3};
  const auto with = [&](int seen, int through, int seen_last, int through_last) {
    Sightings s;
    s.seen = static_cast<std::uint8_t>(seen);
    s.through = static_cast<std::uint8_t>(through);
    s.seen_last = static_cast<std::uint8_t>(seen_last);
    s.through_last = static_cast<std::uint8_t>(through_last);
    return stays(s, config);
  };
  EXPECT_TRUE(with(0, 0, 0, 0));  // in no view for certain
  EXPECT_TRUE(with(1, 0, 1, 0));
  EXPECT_FALSE(with(1, 1, 0, 1));   // contradicted
  EXPECT_FALSE(with(90, 2, 0, 2));  // gone in the end
  EXPECT_TRUE(with(90, 1, 0, 1));   // or a mistake
  EXPECT_TRUE(with(5, 90, 5, 0));   // has come to stay
  EXPECT_FALSE(with(4, 90, 4, 0));
  EXPECT_TRUE(with(8, 2, 4, 0));  // seen through now and then
  EXPECT_FALSE(with(7, 2, 4, 0));
}

TEST(FreeSpace, RefusesRangesOfAnotherCamera) {
  const RangeImage small = range_image(cv::Mat1f(60, 80, 1.0F), {}, {});
  const std::vector<PosedRange> keyframes{{Eigen::Isometry3d::Identity(), &small}};
  const std::vector<Eigen::Vector3f> points{{0, 0, 1}};
  EXPECT_THROW((void)sightings(points, keyframes, camera(), {}), InternalError);
}

TEST(RangeImage, IsTheLeastAroundAndKnowsWhatMoves) {
  cv::Mat1f depth(8, 12, 3.0F);
  depth(0, 0) = 1.0F;
  depth(6, 7) = 0;  // one of four missing: still known
  cv::Mat1b moving(depth.size(), std::uint8_t{0}), excluded;
  moving(4, 5) = 1;
  excluded = moving.clone();
  excluded(0, 11) = 1;
  depth(4, 5) = 1.5F;
  depth(4, 4) = 0.5F;  // in the same block, but it does not move
  const RangeImage image = range_image(depth, {Mask(excluded), Mask(moving)}, {2, 1, 0.25});
  ASSERT_EQ(image.columns, 6);
  ASSERT_EQ(image.rows, 4);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 6; ++column) {
      const RangeCell cell = image.at(row, column);
      const bool moves = row == 2 && column == 2, unknown = row == 0 && column == 5;
      const float expected = unknown ? 0.0F : moves ? 1.5F : row <= 1 && column <= 1 ? 1.0F : 3.0F;
      EXPECT_NEAR(cell.range_m(), expected, 0.0021F) << row << " " << column;
      EXPECT_EQ(cell.known(), !unknown);
      EXPECT_EQ(cell.moving(), moves);
    }
  }
  depth(7, 7) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(range_image(depth, {}, {2, 0, 0.25}).at(3, 3).known());
  EXPECT_TRUE(range_image(depth, {}, {2, 0, 0.5}).at(3, 3).known());
  EXPECT_NEAR(RangeCell(1e9F, false).range_m(), 65.0F, 0.01F);
  EXPECT_THROW((void)range_image(depth, {Mask(cv::Mat1b(3, 3)), {}}, {}), InternalError);
}

}  // namespace
}  // namespace stillmap
