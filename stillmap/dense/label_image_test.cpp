// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/label_image.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulation/synth/sequence.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/system.hpp"

namespace stillmap {
namespace {

constexpr std::uint8_t kChairLabel = 57;  // COCO numbers the chair 56, from 0
constexpr std::uint8_t kTvLabel = 63;     // and the tv 62

TEST(ClassLabel, IsCocosNumberFromOne) {
  EXPECT_EQ(class_label("person"), 1);
  EXPECT_EQ(class_label("chair"), kChairLabel);
  EXPECT_EQ(class_label("tv"), kTvLabel);
  EXPECT_EQ(class_label("tvmonitor"), kTvLabel);
  EXPECT_EQ(class_label("toothbrush"), 80);
  EXPECT_EQ(class_label("desk"), 0);
}

struct LabelledThing {
  const char* class_name;
  cv::Rect area;
  float depth_m;
};

// Things before a wall 3 m away, all of it measured.
struct LabelledScene {
  DepthImage depth{cv::Mat1f(240, 320, 3.0F)};
  FrameObjects objects;
};

LabelledScene scene_of(const std::vector<LabelledThing>& things) {
  LabelledScene scene;
  cv::Mat1b ids(240, 320, std::uint8_t{0});
  for (const LabelledThing& thing : things) {
    TrackedObject object;
    object.detection.id = static_cast<int>(scene.objects.objects.size()) + 1;
    object.detection.class_name = thing.class_name;
    object.detection.score = 0.9F;
    object.detection.box = {static_cast<double>(thing.area.x),
                            static_cast<double>(thing.area.y),
                            static_cast<double>(thing.area.br().x),
                            static_cast<double>(thing.area.br().y)};
    object.track = TrackId(static_cast<std::uint32_t>(object.detection.id));
    ids(thing.area).setTo(object.detection.id);
    scene.depth.mat(thing.area).setTo(thing.depth_m);
    scene.objects.objects.push_back(object);
  }
  scene.objects.mask = ObjectMask(ids);
  return scene;
}

FrameDynamics judged(const LabelledScene& scene) {
  DynamicsConfig config;
  config.mode = "full";
  RgbdFrame frame;
  frame.depth = scene.depth;
  const std::unique_ptr<DynamicsStage> stage =
      make_dynamics_stage(config, synthetic_camera(320, 240), 0);
  return stage->judge(frame, scene.objects, stage->measure(frame, scene.objects), std::nullopt);
}

const LabelledThing kSomebody{"person", {100, 40, 60, 180}, 1.5F};
const LabelledThing kTouchedChair{"chair", {150, 120, 50, 100}, 1.5F};  // overlaps the person
const LabelledThing kChairApart{"chair", {240, 140, 50, 80}, 2.0F};
const LabelledThing kScreen{"tv", {10, 30, 60, 40}, 2.5F};

TEST(LabelImage, HasStaticThingsAndNeverAPerson) {
  const LabelledScene scene = scene_of({kSomebody, kTouchedChair, kChairApart, kScreen});
  const FrameDynamics dynamics = judged(scene);
  ASSERT_TRUE(dynamics.judged.states[1].dynamic);
  ASSERT_FALSE(dynamics.judged.states[2].dynamic);
  cv::Mat1b expected(240, 320, std::uint8_t{0});
  expected(kChairApart.area).setTo(kChairLabel);
  expected(kScreen.area).setTo(kTvLabel);
  EXPECT_EQ(cv::countNonZero(label_image(scene.depth, dynamics).mat != expected), 0);
}

TEST(LabelImage, HasAChairThatRestsThoughSomebodyIsAtIt) {
  const LabelledScene scene = scene_of({kSomebody, kTouchedChair});
  FrameDynamics dynamics = judged(scene);
  dynamics.judged.mask.resting[2] = true;
  cv::Mat1b expected(240, 320, std::uint8_t{0});
  expected(kTouchedChair.area).setTo(kChairLabel);
  EXPECT_EQ(cv::countNonZero(label_image(scene.depth, dynamics).mat != expected), 0);
}

TEST(LabelImage, LeavesOutWhatAMaskHasOfTheWallAndOfNoDepth) {
  LabelledScene scene = scene_of({kChairApart});
  const cv::Rect wall(240, 140, 5, 80), hole(260, 150, 4, 4);
  scene.depth.mat(wall).setTo(3.0F);
  scene.depth.mat(hole).setTo(0.0F);
  const cv::Mat1b labels = label_image(scene.depth, judged(scene)).mat;
  EXPECT_EQ(cv::countNonZero(labels(wall)), 0);
  EXPECT_EQ(cv::countNonZero(labels(hole)), 0);
  EXPECT_EQ(cv::countNonZero(labels), kChairApart.area.area() - wall.area() - hole.area());
}

TEST(LabelImage, ABoxInPlaceOfAMaskIsNoLabel) {
  LabelledScene scene = scene_of({kChairApart, kScreen});
  scene.objects.objects[0].mask_source = MaskSource::kBox;
  scene.objects.objects[1].mask_source = MaskSource::kCarried;
  const cv::Mat1b labels = label_image(scene.depth, judged(scene)).mat;
  EXPECT_EQ(cv::countNonZero(labels), kScreen.area.area());
}

TEST(LabelImage, OfNoObjectsIsEmpty) {
  EXPECT_TRUE(label_image(DepthImage(cv::Mat1f(4, 4, 1.0F)), {}).empty());
}

// One frame, one key frame: exactly what is called a chair is labelled in the map.
TEST(System, LabelsStaticObjectsInTheMap) {
  SyntheticOptions options;
  options.camera = synthetic_camera(320, 240);
  options.frames = 1;
  const SyntheticSequence sequence(options);
  const FramePtr frame = sequence.frame(FrameId(0));
  // Whatever is there, in two parts of the image, is called a person and a chair.
  const LabelledScene pretended =
      scene_of({{"person", {20, 60, 80, 120}, 0}, {"chair", {200, 90, 60, 90}, 0}});
  SystemConfig config;
  config.dynamics.mode = "mask";
  System system(config, options.camera, {.threads = 1});
  const FrameResult result = system.process(frame, pretended.objects);
  ASSERT_TRUE(result.is_keyframe);
  const RunResult done = system.finish();
  ASSERT_EQ(done.map.labels.size(), done.map.size());
  std::size_t labelled = 0, outside = 0;
  for (std::size_t i = 0; i < done.map.size(); ++i) {
    if (done.map.labels[i] == 0) continue;
    ++labelled;
    EXPECT_EQ(done.map.labels[i], kChairLabel);
    const Eigen::Vector2d px = options.camera.project(done.map.positions[i].cast<double>());
    outside += px.x() < 199 || px.x() > 261 || px.y() < 89 || px.y() > 181 ? 1 : 0;
  }
  EXPECT_GT(labelled, 1000U);
  EXPECT_EQ(outside, 0U);
}

}  // namespace
}  // namespace stillmap
