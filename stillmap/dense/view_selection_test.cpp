// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/view_selection.hpp"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

#include "stillmap/dense/global_cloud.hpp"
#include "stillmap/dense/local_cloud.hpp"

namespace stillmap {
namespace {

CameraModel camera() {
  CameraModel camera = builtin_camera("tum_fr3");
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx = camera.fy = 130;
  camera.cx = 80;
  camera.cy = 60;
  return camera;
}

struct Chair {
  cv::Rect pixels;
  Rgb color;
};

const Chair kHere{{20, 60, 24, 24}, {0, 0, 250}};  // 3 % of the image
const Chair kThere{{100, 60, 24, 24}, {0, 0, 251}};

/// A wall, `wall_m` before the camera, and chairs a metre before the wall.
StaticView view_of(const std::vector<Chair>& chairs, float wall_m = 3) {
  cv::Mat1f depth(120, 160, wall_m);
  ColorImage color(cv::Mat3b(120, 160, cv::Vec3b(200, 200, 200)));
  for (const Chair& chair : chairs) {
    depth(chair.pixels).setTo(wall_m - 1);
    color.mat(chair.pixels).setTo(cv::Scalar(chair.color[0], chair.color[1], chair.color[2]));
  }
  return {compact(local_cloud(depth, color, pixel_rays(camera()), {})), range_image(depth, {}, {})};
}

/// Holds the views that are news to it.
class Chooser {
 public:
  explicit Chooser(const ViewSelectionConfig& config = {}) : config_(config) {}

  /// How many of `times` equal views joined.
  int show(const StaticView& view,
           int times,
           const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity()) {
    int joined = 0;
    for (int i = 0; i < times; ++i) {
      const PosedView posed{T, &view};
      if (config_.enough > 0) {
        const ViewGain gain = gain_of(posed, held_, camera(), config_, {});
        if (!is_worth_keeping(gain, config_)) continue;
        std::erase_if(held_, [&](const PosedView& v) { return v.view == gain.replaces; });
      }
      views_.push_back(view);
      held_.push_back({T, &views_.back()});
      ++joined;
    }
    return joined;
  }

  [[nodiscard]] const std::vector<PosedView>& held() const { return held_; }

  /// Points of a colour in the map of the views held.
  [[nodiscard]] std::size_t count(const Rgb& color) const {
    std::vector<PosedCloud> clouds;
    std::vector<PosedRange> ranges;
    for (const PosedView& view : held_) {
      clouds.push_back({view.T_world_camera, &view.view->cloud});
      ranges.push_back({view.T_world_camera, &view.view->range});
    }
    const PointCloud map = without_moved(global_cloud(clouds, 0.02), ranges, camera(), {});
    return static_cast<std::size_t>(std::ranges::count(map.colors, color));
  }

 private:
  ViewSelectionConfig config_;
  std::deque<StaticView> views_;
  std::vector<PosedView> held_;
};

TEST(ViewChoice, AWallIsKnownAfterEnoughViews) {
  EXPECT_EQ(Chooser().show(view_of({}), 100), 20);
  EXPECT_EQ(Chooser({.enough = 5}).show(view_of({}), 100), 5);
  EXPECT_EQ(Chooser({.enough = 0}).show(view_of({}), 100), 100);
}

TEST(ViewChoice, NewSurfaceIsNews) {
  Chooser chooser;
  chooser.show(view_of({}), 30);
  const Eigen::Isometry3d aside(Eigen::Translation3d(0.3, 0, 0));  // 8 % of the image
  const Eigen::Isometry3d far_aside(Eigen::Translation3d(0.5, 0, 0));
  EXPECT_EQ(chooser.show(view_of({}), 30, aside), 0);
  EXPECT_EQ(chooser.show(view_of({}), 30, far_aside), 20);
}

TEST(ViewChoice, ANearerLookIsNews) {
  const Eigen::Isometry3d nearer(Eigen::Translation3d(0, 0, 1.5));
  const Eigen::Isometry3d little_nearer(Eigen::Translation3d(0, 0, 0.5));
  Chooser chooser;
  chooser.show(view_of({}), 30);
  EXPECT_EQ(chooser.show(view_of({}, 2.5), 30, little_nearer), 0);
  EXPECT_EQ(chooser.show(view_of({}, 1.5), 30, nearer), 20);
  // A farther one is none, and neither is a nearer one to who does not ask.
  EXPECT_EQ(chooser.show(view_of({}), 30), 0);
  Chooser careless({.nearer = 1000});
  careless.show(view_of({}), 30);
  EXPECT_EQ(careless.show(view_of({}, 1.5), 30, nearer), 0);
}

TEST(ViewChoice, WhatWentIsNewsUntilTheMapHasItNoMore) {
  for (const double share : {ViewSelectionConfig{}.min_changed_share, 1.0}) {
    Chooser chooser({.min_changed_share = share});
    chooser.show(view_of({kHere}), 30);
    ASSERT_GT(chooser.count(kHere.color), 100U);
    const int joined = chooser.show(view_of({}), 50);
    if (share < 1) {
      EXPECT_GE(joined, 2);
      EXPECT_LE(joined, 10);
      EXPECT_EQ(chooser.count(kHere.color), 0U);
    } else {
      EXPECT_EQ(joined, 0);
      EXPECT_GT(chooser.count(kHere.color), 100U);  // a ghost
    }
  }
}

TEST(ViewChoice, WhatCameIsNewsUntilTheMapHasIt) {
  for (const double share : {ViewSelectionConfig{}.min_changed_share, 1.0}) {
    Chooser chooser({.min_changed_share = share});
    chooser.show(view_of({}), 30);
    const int joined = chooser.show(view_of({kThere}), 50);
    if (share < 1) {
      EXPECT_GE(joined, 2);
      EXPECT_LE(joined, 10);
      EXPECT_GT(chooser.count(kThere.color), 100U);
    } else {
      EXPECT_EQ(joined, 0);
      EXPECT_EQ(chooser.count(kThere.color), 0U);
    }
  }
}

TEST(ViewChoice, AChairThatIsPushedToAndFroIsWhereItIs) {
  Chooser chooser;
  int joined = 0;
  for (int round = 0; round < 3; ++round) {
    joined += chooser.show(view_of({kHere}), 50);
    EXPECT_GT(chooser.count(kHere.color), 100U) << round;
    EXPECT_EQ(chooser.count(kThere.color), 0U) << round;
    joined += chooser.show(view_of({kThere}), 50);
    EXPECT_EQ(chooser.count(kHere.color), 0U) << round;
    EXPECT_GT(chooser.count(kThere.color), 100U) << round;
  }
  EXPECT_LT(joined, 90);  // of 300
}

TEST(ViewChoice, AViewOfACrowdedPlaceTakesThatOfOneThatIsNotNeeded) {
  // Every view counts as news here.
  Chooser chooser({.enough = 1000, .most = 30});
  const Eigen::Isometry3d aside(Eigen::Translation3d(0.5, 0, 0));   // sees 0.87 of the same wall
  const Eigen::Isometry3d nearer(Eigen::Translation3d(0, 0, 1.5));  // from half as far
  const Eigen::Isometry3d elsewhere(Eigen::Translation3d(50, 0, 0));
  EXPECT_EQ(chooser.show(view_of({}), 20), 20);
  EXPECT_EQ(chooser.show(view_of({}, 1.5), 3, nearer), 3);
  EXPECT_EQ(chooser.show(view_of({}), 50, aside), 50);
  EXPECT_EQ(chooser.show(view_of({}), 3, elsewhere), 3);
  const auto held_at = [&](const Eigen::Isometry3d& T) {
    return std::ranges::count_if(chooser.held(), [&](const PosedView& v) {
      return v.T_world_camera.translation() == T.translation();
    });
  };
  EXPECT_EQ(held_at(Eigen::Isometry3d::Identity()), 5) << "which show the margin that others lack";
  EXPECT_EQ(held_at(nearer), 3) << "from too near to be like the others";
  EXPECT_EQ(held_at(aside), 25) << "30 see half of the wall, the first among them";
  EXPECT_EQ(held_at(elsewhere), 3);
}

TEST(ViewChoice, TheViewThatOthersShowTooIsNeededLeast) {
  const StaticView same = view_of({}), alone = view_of({}), newest = view_of({});
  const Eigen::Isometry3d elsewhere(Eigen::Translation3d(50, 0, 0));
  std::vector<StaticView> many(6, same);
  std::vector<PosedView> held = {{elsewhere, &alone}};
  for (const StaticView& view : many) held.push_back({Eigen::Isometry3d::Identity(), &view});
  const PosedView last{Eigen::Isometry3d::Identity(), &newest};
  EXPECT_EQ(least_needed(held, last, camera(), {}, {}), &many[0]);
  const std::vector<PosedView> one = {held[0]};
  EXPECT_EQ(least_needed(one, last, camera(), {}, {}), &alone);
  EXPECT_EQ(least_needed({}, last, camera(), {}, {}), nullptr);
}

TEST(ViewChoice, ViewsWithoutPointsOrRangeAreNoTrouble) {
  Chooser chooser;
  EXPECT_EQ(chooser.show({}, 5), 0);
  StaticView blind = view_of({});
  blind.range = {};
  EXPECT_EQ(chooser.show(blind, 5), 5);  // they do not tell what they have seen
  EXPECT_EQ(chooser.show(view_of({}), 50), 20);
}

}  // namespace
}  // namespace stillmap
