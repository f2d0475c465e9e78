// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/dynamics_stage.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

const CameraModel& small_camera() {
  static const CameraModel kCamera = [] {
    CameraModel camera;
    camera.width_px = 160;
    camera.height_px = 120;
    camera.fx = camera.fy = 130;
    camera.cx = 80;
    camera.cy = 60;
    return camera;
  }();
  return kCamera;
}

const cv::Rect kPerson(60, 20, 40, 90);

// A wall 3 m from the camera, optionally with a person at 1.5 m.
RgbdFrame wall(bool with_person) {
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(120, 160, 3.0F));
  if (with_person) cv::Mat1f(frame.depth.mat, kPerson).setTo(1.5F);
  return frame;
}

FrameObjects person_found() {
  FrameObjects objects;
  cv::Mat1b mask(120, 160, std::uint8_t{0});
  cv::Mat1b(mask, kPerson).setTo(1);
  objects.mask = ObjectMask(mask);
  objects.objects.push_back({{1, "person", 1.0F, {60, 20, 100, 110}}, TrackId(0), {}, {}});
  return objects;
}

bool person_is_out(const FrameDynamics& dynamics) {
  return dynamics.excluded.covers(60, 80) && !dynamics.excluded.covers(60, 20);
}

using Pose = std::optional<Eigen::Isometry3d>;

// A camera at the world's origin, turned so that the wall is in view or not.
Eigen::Isometry3d turned(double degrees) {
  return make_pose(so3_exp(Eigen::Vector3d(0, degrees * 3.14159265358979 / 180, 0)),
                   Eigen::Vector3d::Zero());
}

// A false person: the mask lies on the wall, whose depth is unchanged.
class DoubtedPerson : public testing::Test {
 protected:
  FrameDynamics look(float score, const std::string& name = "person") {
    FrameObjects objects = person_found();
    objects.objects[0].detection.score = score;
    objects.objects[0].detection.class_name = name;
    objects.objects[0].track = TrackId(3);
    objects.stamp.seconds = ++frame_ / 30.0;
    const RgbdFrame frame = wall(false);
    const FrameDynamics dynamics =
        stage_->judge(frame, objects, stage_->measure(frame, objects), turned(0));
    (void)stage_->with_motion(frame, turned(0), dynamics);
    stage_->remember(frame, turned(0), dynamics);
    return dynamics;
  }

  int frame_ = 0;
  std::unique_ptr<DynamicsStage> stage_ = make_dynamics_stage({}, small_camera(), 0);
};

TEST_F(DoubtedPerson, IsDoubtedTheMoreTheLessTheNetworkIsSure) {
  float before = 1;
  for (const float score : {0.1F, 0.5F, 0.9F}) {
    const std::optional<DoubtedPixels> doubted = stage_->doubted(look(score));
    ASSERT_TRUE(doubted);
    EXPECT_FALSE(doubted->others.covers(60, 80));  // on the person
    EXPECT_TRUE(doubted->others.covers(60, 20));   // on the wall, which has features already
    EXPECT_LT(doubted->trust(60, 80), before);
    EXPECT_GT(doubted->trust(60, 80), 0);
    before = doubted->trust(60, 80);
  }
}

TEST_F(DoubtedPerson, IsTrustedMoreWhenItHasStoodThereForLong) {
  const float at_first = stage_->doubted(look(0.9F))->trust(60, 80);
  FrameDynamics dynamics;
  for (int k = 0; k < 60; ++k) dynamics = look(0.9F);
  EXPECT_GT(stage_->doubted(dynamics)->trust(60, 80), 2 * at_first);
  EXPECT_TRUE(dynamics.excluded_from_pose.covers(60, 80));  // people sway
}

TEST_F(DoubtedPerson, AThingThatHasStoodThereIsStaticForThePoseAndTheMap) {
  DynamicsConfig config;
  config.objects.categories = {.dynamic = "dog", .potentially_dynamic = "person"};
  config.motion.standing_frames = 20;
  stage_ = make_dynamics_stage(config, small_camera(), 0);
  const RgbdFrame frame = wall(false);
  FrameDynamics dynamics;
  for (int k = 0; k < 60; ++k) {
    FrameObjects objects = person_found();
    objects.objects.push_back({{2, "dog", 1.0F, {60, 20, 100, 110}}, TrackId(1), {}, {}});
    objects.stamp.seconds = k / 30.0;
    dynamics = stage_->judge(frame, objects, stage_->measure(frame, objects), turned(0));
    ASSERT_TRUE(dynamics.judged.states[0].dynamic) << "the dog is at it";
    (void)stage_->with_motion(frame, turned(0), dynamics);
    stage_->remember(frame, turned(0), dynamics);
    EXPECT_EQ(dynamics.excluded_from_pose.covers(60, 80), k < 4 + 20) << k;
    EXPECT_EQ(dynamics.excluded.covers(60, 80), k < 4 + 20) << k;
    EXPECT_EQ(dynamics.judged.mask.resting[1], k >= 4 + 20) << k;
    EXPECT_FALSE(dynamics.judged.mask.resting[2]) << "dogs sway";
  }
}

TEST(DynamicsStage, OtherModesDoubtNothing) {
  for (const char* mode : {"off", "mask", "ds-slam", "dynaslam", "paper"}) {
    DynamicsConfig config;
    config.mode = mode;
    const std::unique_ptr<DynamicsStage> stage = make_dynamics_stage(config, small_camera(), 0);
    const RgbdFrame frame = wall(true);
    const FrameObjects objects = person_found();
    const FrameDynamics dynamics =
        stage->judge(frame, objects, stage->measure(frame, objects), turned(0));
    EXPECT_FALSE(stage->doubted(dynamics)) << mode;
  }
}

// Without detections somebody enters; points of earlier frames on the wall are hidden then.
TEST(DynamicsStage, DynaslamFindsWhatHidesEarlierPoints) {
  DynamicsConfig config;
  config.mode = "dynaslam";
  const std::unique_ptr<DynamicsStage> stage = make_dynamics_stage(config, small_camera(), 0);
  Features points;
  for (int i = 0; i < 140 * 100; i += 37) {
    points.raw_px.emplace_back(10 + i % 140, 10 + i / 140);
    points.sensor_depth_m.push_back(3.0F);
    points.depth_m.push_back(3.0F);
    points.level.push_back(0);
    points.angle_deg.push_back(0);
    points.descriptors.emplace_back();
  }
  points.ideal_px = points.px = points.raw_px;
  const auto look = [&](bool with_person) {
    const RgbdFrame frame = wall(with_person);
    FrameDynamics dynamics = stage->judge(frame, {}, stage->measure(frame, {}), turned(0));
    (void)stage->filter(frame, points, dynamics, turned(0));
    stage->remember(frame, turned(0), dynamics);
    return dynamics;
  };
  for (int k = 0; k < 8; ++k) EXPECT_FALSE(person_is_out(look(false)));
  EXPECT_TRUE(person_is_out(look(true)));
}

// Fan 2020, Eqs. (4) and (17): no margin; features are not dropped at depth jumps.
TEST(DynamicsStage, PaperLeavesOutExactlyMasksAndJumps) {
  for (const bool searched : {false, true}) {
    DynamicsConfig config;
    config.mode = "paper";
    config.search_masks = searched;
    config.objects.extension.whole_box_px = 0;
    const std::unique_ptr<DynamicsStage> stage = make_dynamics_stage(config, small_camera(), 0);
    const RgbdFrame before = wall(false);
    stage->remember(before, turned(0), stage->judge(before, {}, {}, turned(0)));
    RgbdFrame frame = wall(true);
    frame.depth.mat(0, 0) = 4.1F;  // farther than a metre behind the wall
    const FrameObjects objects = person_found();
    const FrameDynamics dynamics =
        stage->judge(frame, objects, stage->measure(frame, objects), turned(0));
    EXPECT_EQ(cv::countNonZero(dynamics.excluded.mat), kPerson.area() + 1);
    EXPECT_EQ(cv::countNonZero(dynamics.excluded_from_pose.mat), kPerson.area());
    EXPECT_EQ(dynamics.unsearched.empty(), searched);
  }
}

class DynamicsStageWhenLost : public testing::Test {
 protected:
  [[nodiscard]] FrameDynamics judge(const RgbdFrame& frame,
                                    const FrameObjects& objects,
                                    const Pose& expected) const {
    return stage_->judge(frame, objects, stage_->measure(frame, objects), expected);
  }

  void SetUp() override {
    for (int k = 0; k < 31; ++k) {
      const FrameDynamics dynamics = judge(wall(false), {}, turned(0));
      stage_->remember(wall(false), turned(0), dynamics);
    }
    stage_->forget();
  }

  std::unique_ptr<DynamicsStage> stage_ = make_dynamics_stage({}, small_camera(), 0);
};

TEST_F(DynamicsStageWhenLost, TheNetworksPeopleAreOutWithoutAPose) {
  EXPECT_TRUE(person_is_out(judge(wall(true), person_found(), std::nullopt)));
}

TEST_F(DynamicsStageWhenLost, WhoIsMissedIsSeenByWhatWasThereBefore) {
  EXPECT_FALSE(person_is_out(judge(wall(true), {}, std::nullopt)));
  // Relocalised in a frame that shows the person already, so that this frame tells nothing.
  const FrameDynamics found = judge(wall(true), {}, std::nullopt);
  stage_->remember(wall(true), turned(0), found);
  EXPECT_TRUE(person_is_out(judge(wall(true), {}, turned(0))));
}

TEST_F(DynamicsStageWhenLost, WhereNothingWasSeenTheFirstFrameTells) {
  for (int k = 0; k < 3; ++k) {
    const FrameDynamics found = judge(wall(false), {}, Pose(turned(180)));
    stage_->remember(wall(false), turned(180), found);
    const FrameDynamics entered = judge(wall(true), {}, turned(180));
    EXPECT_TRUE(person_is_out(entered)) << k;
  }
}

TEST_F(DynamicsStageWhenLost, WhoStandsThereAllTheTimeIsNotSeenByDepth) {
  const FrameDynamics found = judge(wall(true), {}, Pose(turned(180)));
  stage_->remember(wall(true), turned(180), found);
  EXPECT_FALSE(person_is_out(judge(wall(true), {}, turned(180))));
}

}  // namespace
}  // namespace stillmap
