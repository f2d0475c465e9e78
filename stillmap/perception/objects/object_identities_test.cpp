// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_identities.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

const cv::Vec3b kRed{200, 20, 20}, kBlue{20, 20, 200}, kGreen{20, 200, 20};

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 320;
  camera.height_px = 240;
  camera.fx = camera.fy = 260;
  camera.cx = 160;
  camera.cy = 120;
  return camera;
}

/// An upright rectangle that faces along z, with its middle at a point of the world.
struct Panel {
  std::uint32_t tracklet = 0;
  std::string class_name = "chair";
  Eigen::Vector3d p_world;
  double width_m = 0.4, height_m = 0.6;
  cv::Vec3b color = kRed;
  std::optional<BoxOrigin> filled = {};
};

/// A room whose wall is 6 m away, in which panels are seen and identified.
class PanelRoom {
 public:
  explicit PanelRoom(const IdentityConfig& config = {})
      : identities_(config, CategoryTable({}), camera_) {}

  /// The tracks of the panels in a frame taken `at_s` with the camera at `camera_x_m`.
  std::vector<std::uint32_t> see(double at_s,
                                 const std::vector<Panel>& panels,
                                 double camera_x_m = 0,
                                 bool has_pose = true) {
    const cv::Size size(camera_.width_px, camera_.height_px);
    RgbdFrame frame;
    frame.color = ColorImage(cv::Mat3b(size, cv::Vec3b(120, 120, 120)));
    frame.depth = DepthImage(cv::Mat1f(size, 6.0F));
    FrameObjects objects;
    objects.stamp = {at_s, ""};
    objects.mask = ObjectMask(cv::Mat1b(size, std::uint8_t{0}));
    for (const Panel& panel : panels) {
      const Eigen::Vector3d p = panel.p_world - Eigen::Vector3d(camera_x_m, 0, 0);
      const Eigen::Vector3d half(panel.width_m / 2, panel.height_m / 2, 0);
      const Eigen::Vector2d low = camera_.project(p - half), high = camera_.project(p + half);
      const PixelBox box{low.x(), low.y(), high.x(), high.y()};
      const auto id = static_cast<std::uint8_t>(objects.objects.size() + 1);
      const cv::Rect area = cv::Rect(cv::Point(std::lround(box.x0), std::lround(box.y0)),
                                     cv::Point(std::lround(box.x1), std::lround(box.y1))) &
                            cv::Rect({}, size);
      frame.color.mat(area) = panel.color;
      frame.depth.mat(area) = static_cast<float>(p.z());
      objects.mask.mat(area) = id;
      objects.objects.push_back(
          {{id, panel.class_name, 0.9F, box}, TrackId(panel.tracklet), panel.filled});
    }
    const MaskAreas areas = mask_areas(objects.mask);
    std::vector<ObjectDepths> depths;
    for (const TrackedObject& object : objects.objects) {
      const int id = object.detection.id;
      depths.push_back(object_depths(
          frame.depth, objects.mask, id, areas[static_cast<std::size_t>(id)], OutlierRule{}));
    }
    std::optional<Eigen::Isometry3d> T_odometry_camera;
    if (has_pose) T_odometry_camera = Eigen::Translation3d(camera_x_m, 0, 0);
    std::vector<std::uint32_t> tracks;
    IdentifiedObjects identified =
        identities_.identify(frame, objects, areas, depths, T_odometry_camera);
    for (const TrackId track : identified.tracks) tracks.push_back(track.value);
    movers_ = std::move(identified.movers);
    return tracks;
  }

  void know(std::vector<KnownObject> objects) { identities_.know(std::move(objects)); }
  void place(const Eigen::Isometry3d& T_odometry_world, double now_s) {
    identities_.place(T_odometry_world, now_s);
  }
  [[nodiscard]] const ObjectIdentities& identities() const { return identities_; }
  /// Of the last frame.
  [[nodiscard]] const std::vector<MoverSighting>& movers() const { return movers_; }

 private:
  std::vector<MoverSighting> movers_;
  CameraModel camera_ = small_camera();
  ObjectIdentities identities_;
};

Panel person(std::uint32_t tracklet, double x_m, cv::Vec3b color) {
  return {tracklet, "person", {x_m, 0, 2.5}, 0.5, 1.6, color};
}

using Tracks = std::vector<std::uint32_t>;

TEST(ObjectIdentities, AThingHasItsTrackAfterTheCameraLookedElsewhere) {
  PanelRoom room;
  const Tracks first = room.see(0, {{3, "chair", {0.2, 0, 2}}});
  EXPECT_EQ(room.see(0.1, {{3, "chair", {0.2, 0, 2}}}), first);
  EXPECT_EQ(room.see(20, {{9, "chair", {0.25, 0, 2.05}}}, 0.7), first);
  EXPECT_EQ(room.see(30, {{12, "couch", {0.2, 0, 2}}}), first) << "a class often taken for it";
  EXPECT_NE(room.see(40, {{15, "tv", {0.2, 0, 2}}}), first);

  IdentityConfig off;
  off.enabled = false;
  PanelRoom without(off);
  EXPECT_NE(without.see(0, {{3, "chair", {0.2, 0, 2}}}),
            without.see(20, {{9, "chair", {0.2, 0, 2}}}));
}

TEST(ObjectIdentities, AThingElsewhereIsAnother) {
  PanelRoom room;
  const Tracks first = room.see(0, {{3, "chair", {-0.4, 0, 2}}});
  EXPECT_NE(room.see(5, {{4, "chair", {0.6, 0, 2}}}), first);
  const Tracks both = room.see(9, {{5, "chair", {0.6, 0, 2}}, {6, "chair", {-0.4, 0, 2}}});
  EXPECT_EQ(both.at(1), first.at(0));
  EXPECT_NE(both.at(0), first.at(0));
}

TEST(ObjectIdentities, PeopleAreFoundAgainByTheirColors) {
  PanelRoom room;
  const Tracks first = room.see(0, {person(0, -0.6, kRed), person(1, 0.6, kBlue)});
  const Tracks later = room.see(9, {person(2, -0.6, kBlue), person(3, 0.6, kRed)});
  EXPECT_EQ(later, (Tracks{first.at(1), first.at(0)}));
  EXPECT_NE(room.see(20, {person(4, 0, kGreen)}).at(0), first.at(0));
}

TEST(ObjectIdentities, AMaskFilledInTellsNoPlaceOfAPerson) {
  PanelRoom room;
  Panel panel = person(1, 0, kRed);
  room.see(0, {panel});
  ASSERT_EQ(room.movers().size(), 1U);
  EXPECT_FALSE(room.movers()[0].surface.empty());
  panel.filled = BoxOrigin{FrameId(0), std::nullopt};
  room.see(0.03, {panel});
  ASSERT_EQ(room.movers().size(), 1U) << "the person is in the frame";
  EXPECT_TRUE(room.movers()[0].surface.empty()) << "but perhaps behind what is seen there";
}

TEST(ObjectIdentities, APersonIsFoundAgainOnlyWithinTheDistanceWalked) {
  const Tracks first{0};
  PanelRoom soon, later;
  ASSERT_EQ(soon.see(0, {person(0, -1.1, kRed)}), first);
  ASSERT_EQ(later.see(0, {person(0, -1.1, kRed)}), first);
  EXPECT_NE(soon.see(0.5, {person(1, 1.1, kRed)}), first);
  EXPECT_EQ(later.see(2.0, {person(1, 1.1, kRed)}), first);
}

TEST(ObjectIdentities, ALegSeenApartIsPartOfThePerson) {
  PanelRoom room;
  const Panel leg{1, "person", {0.1, 1.0, 2.5}, 0.15, 0.3, kBlue};
  const Tracks tracks = room.see(0, {person(0, 0, kRed), leg});
  EXPECT_EQ(tracks.at(0), tracks.at(1));
  const Tracks others = room.see(1, {person(0, 0, kRed), person(2, 0.8, kRed)});
  EXPECT_NE(others.at(0), others.at(1)) << "another person is no part";
}

TEST(ObjectIdentities, ATrackThatJumpsIsTwoPeople) {
  PanelRoom room;
  const Tracks first = room.see(0, {person(0, -0.6, kRed)});
  EXPECT_EQ(room.see(0.03, {person(0, -0.55, kRed)}), first);
  EXPECT_NE(room.see(0.06, {person(0, 0.8, kBlue)}), first);
}

TEST(ObjectIdentities, TracksThatTurnOutToBeOneAreUnited) {
  PanelRoom room;
  const Tracks first = room.see(0, {{3, "chair", {0.2, 0, 2}}});
  const Tracks lost = room.see(8, {{9, "chair", {0.2, 0, 2}}}, 0, false);  // its place is unknown
  ASSERT_NE(lost, first);
  EXPECT_EQ(room.see(8.1, {{9, "chair", {0.2, 0, 2}}}), first);
  ASSERT_EQ(room.identities().united().size(), 1U);
  EXPECT_EQ(room.identities().united().front().later, TrackId(lost.at(0)));
  EXPECT_EQ(room.identities().united().front().earlier, TrackId(first.at(0)));
  EXPECT_EQ(room.identities().known().size(), 1U);
}

TEST(ObjectIdentities, AnEarlierRunsObjectsAreFoundWhereTheMapHasThem) {
  PanelRoom earlier;
  const Tracks chair = earlier.see(0, {{3, "chair", {0.2, 0, 2}}});
  // The earlier run's world lies 1 m to the right of this run's odometry frame.
  const Eigen::Isometry3d T_odometry_world(Eigen::Translation3d(1, 0, 0));
  PanelRoom room;
  room.know(earlier.identities().all_in_world(Eigen::Isometry3d::Identity()));
  const Tracks lost = room.see(100, {{5, "chair", {0.2, 0, 2}}});
  EXPECT_NE(lost, chair) << "its place is not known yet";
  room.place(T_odometry_world, 101);
  EXPECT_EQ(room.see(101, {{6, "chair", {1.2, 0, 2}}}, 1.0), chair);
  EXPECT_EQ(room.see(102, {{5, "chair", {0.2, 0, 2}}}), lost);
  const std::vector<KnownObject> saved = room.identities().all_in_world(T_odometry_world);
  ASSERT_EQ(saved.size(), 2U);
  EXPECT_NEAR(saved[0].extent.center().x(), 0.2, 0.03) << "in the world frame again";
}

}  // namespace
}  // namespace stillmap
