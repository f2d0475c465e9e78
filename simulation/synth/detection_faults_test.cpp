// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/detection_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/synth/truth.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

const cv::Size kImage(640, 480);
const cv::Size kSmallImage(320, 240);

struct Figure {
  int id;
  std::string class_name;
  cv::Point2d center;  // in pixels of 640x480
  double height;
  double visible_share = 1;
};

// Head, trunk, arms and legs.
void draw(cv::Mat1b& mask, const Figure& figure, double scale) {
  const auto part = [&](double x, double y, double half_width, double half_height) {
    const double size = figure.height * scale;
    const cv::Point2d center = figure.center * scale + cv::Point2d(x, y) * size;
    cv::ellipse(mask,
                cv::Point(center),
                cv::Size(static_cast<int>(half_width * size), static_cast<int>(half_height * size)),
                0.0,
                0.0,
                360.0,
                cv::Scalar(figure.id),
                cv::FILLED);
  };
  part(0, -0.42, 0.06, 0.08);
  part(0, -0.15, 0.12, 0.2);
  part(-0.16, -0.12, 0.04, 0.2);
  part(0.16, -0.12, 0.04, 0.2);
  part(-0.07, 0.27, 0.05, 0.23);
  part(0.07, 0.27, 0.05, 0.23);
}

FrameTruth truth_of(std::uint32_t frame,
                    const std::vector<Figure>& figures,
                    cv::Size image = kImage) {
  FrameTruth truth;
  truth.frame = FrameId(frame);
  truth.stamp.text = fmt::format("{}.5", frame);
  truth.stamp.seconds = frame + 0.5;
  truth.mask.mat = cv::Mat1b(image, std::uint8_t{0});
  std::vector<ObjectSpeed> speeds;
  for (const Figure& figure : figures) {
    draw(truth.mask.mat, figure, image.width / 640.0);
    speeds.push_back({figure.id, 0.0});
  }
  const std::vector<TruthFrameObject> objects = frame_objects(truth.mask, speeds);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const TruthFrameObject& object = objects[i];
    truth.objects.push_back(
        {object.id, figures[i].class_name, object.box, object.pixels, figures[i].visible_share});
  }
  return truth;
}

// A person who walks across the image.
FrameTruth walker(std::uint32_t frame, cv::Size image = kImage) {
  const double x = 120.0 + frame % 400;
  return truth_of(frame, {{1, "person", {x, 240.0}, 400.0}}, image);
}

DetectionFaultOptions no_faults() {
  return {.edge_loss_px = 0,
          .edge_wander_px = 0,
          .limb_loss = 0,
          .leak = 0,
          .box_shift_px = 0,
          .miss_rate = 0,
          .min_pixels = 0,
          .min_visible_share = 0,
          .duplicate_rate = 0,
          .false_rate = 0};
}

double overlap(const cv::Mat1b& a, const cv::Mat1b& b) {
  return cv::countNonZero(a & b) / static_cast<double>(cv::countNonZero(a | b));
}

bool same(const FrameDetections& a, const FrameDetections& b) {
  return a.objects == b.objects && a.mask.mat.size() == b.mask.mat.size() &&
         (a.mask.mat.empty() || cv::norm(a.mask.mat, b.mask.mat, cv::NORM_INF) == 0);
}

TEST(PerfectDetections, AreTheTruthOfClassesThatNetworksKnow) {
  const FrameTruth truth = truth_of(3,
                                    {{10, "chair", {500, 300}, 200},
                                     {1, "person", {200, 240}, 400},
                                     {13, "box", {210, 240}, 100},
                                     {12, "chair", {-900, 300}, 200}});
  ASSERT_GT(cv::countNonZero(truth.mask.mat == 13), 0);
  const FrameDetections perfect = perfect_detections(truth);
  EXPECT_EQ(perfect.stamp.text, "3.5");
  const std::vector<DetectedObject> expected = {{10, "chair", 1.F, truth.objects[0].box},
                                                {1, "person", 1.F, truth.objects[1].box}};
  EXPECT_EQ(perfect.objects, expected);
  cv::Mat1b mask = truth.mask.mat.clone();
  mask.setTo(0, mask == 13);
  EXPECT_EQ(cv::norm(perfect.mask.mat, mask, cv::NORM_INF), 0);
  EXPECT_TRUE(perfect_detections(truth_of(0, {})).mask.mat.empty());
}

TEST(DetectionFaults, WithoutFaultsGiveTheTruthButForIdsAndScores) {
  const FrameTruth truth =
      truth_of(3, {{7, "chair", {500, 300}, 200}, {9, "person", {200, 240}, 400}});
  const FrameDetections found = DetectionFaults(1, no_faults()).apply(truth);
  ASSERT_EQ(found.objects.size(), 2U);
  for (const DetectedObject& object : found.objects) {
    const int id = object.class_name == "chair" ? 7 : 9;
    EXPECT_EQ(overlap(found.mask.mat == object.id, truth.mask.mat == id), 1.0);
    EXPECT_EQ(object.box, truth.objects[id == 7 ? 0 : 1].box);
    EXPECT_LT(object.score, 1.F);
  }
}

TEST(DetectionFaults, MasksResembleTheTruthButAreNeverIt) {
  for (const cv::Size image : {kImage, kSmallImage}) {
    const DetectionFaults faults(7);
    double sum = 0, worst = 1, lost = 0, added = 0;
    int found = 0;
    for (std::uint32_t frame = 0; frame < 300; ++frame) {
      const FrameTruth truth = walker(frame, image);
      const FrameDetections detections = faults.apply(truth);
      if (detections.mask.mat.empty() || faults.overlooked(1, truth.frame)) continue;
      const cv::Mat1b own = truth.mask.mat == 1;
      const auto shows = [&](const DetectedObject& object) {
        return cv::countNonZero((detections.mask.mat == object.id) & own) > 1000;
      };
      const auto person = std::ranges::find_if(detections.objects, shows);
      ASSERT_NE(person, detections.objects.end());
      const cv::Mat1b reported = detections.mask.mat == person->id;
      const double share = overlap(own, reported);
      EXPECT_LT(share, 1.0);
      EXPECT_GT(share, 0.4);
      worst = std::min(worst, share);
      sum += share;
      lost += cv::countNonZero(own & ~reported);
      added += cv::countNonZero(~own & reported);
      ++found;
    }
    EXPECT_GT(found, 250);
    EXPECT_GT(sum / found, 0.6);
    EXPECT_LT(sum / found, 0.95);
    EXPECT_LT(worst, sum / found - 0.1) << "some frames are much worse than others";
    EXPECT_GT(lost, added);
    EXPECT_GT(added, 0.02 * lost);
  }
}

TEST(DetectionFaults, OverlookForOneToThreeFramesInARow) {
  const DetectionFaults faults(11);
  std::map<int, int> runs;
  int missed = 0;
  constexpr int kObjects = 40, kFrames = 2000;
  for (int id = 1; id <= kObjects; ++id) {
    int run = 0;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      const bool overlooked = faults.overlooked(id, FrameId(frame));
      if (!overlooked && run > 0) ++runs[run];
      run = overlooked ? run + 1 : 0;
      missed += overlooked ? 1 : 0;
    }
  }
  const double rate = missed / static_cast<double>(kObjects * kFrames);
  EXPECT_GT(rate, 0.055);
  EXPECT_LT(rate, 0.075);
  EXPECT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs.begin()->first, 1);
  EXPECT_EQ(runs.rbegin()->first, 3);
  for (const auto& [length, count] : runs) EXPECT_GT(count, missed / 10) << length;
}

TEST(DetectionFaults, ReportNothingOfWhatIsOverlooked) {
  DetectionFaultOptions options = no_faults();
  options.miss_rate = 0.1;
  const DetectionFaults faults(11, options);
  int missed = 0;
  for (std::uint32_t frame = 0; frame < 200; ++frame) {
    const FrameDetections detections = faults.apply(walker(frame, kSmallImage));
    const bool overlooked = faults.overlooked(1, FrameId(frame));
    EXPECT_EQ(detections.objects.empty(), overlooked) << frame;
    EXPECT_EQ(detections.mask.mat.empty(), overlooked) << frame;
    missed += overlooked ? 1 : 0;
  }
  EXPECT_GT(missed, 5);
  EXPECT_LT(missed, 40);
}

TEST(DetectionFaults, NeverSeeWhatIsSmallHalfOutOfViewOrOfNoKnownClass) {
  DetectionFaultOptions options;
  options.false_rate = 0;
  const DetectionFaults faults(3, options);
  const auto ever_seen = [&](const Figure& figure, cv::Size image = kImage) {
    bool seen = false;
    for (std::uint32_t frame = 0; frame < 20; ++frame) {
      seen |= !faults.apply(truth_of(frame, {figure}, image)).objects.empty();
    }
    return seen;
  };
  // A figure covers about 0.23 of the square of its height: 48 -> 520 pixels, 62 -> 870.
  const Figure small = {1, "person", {300, 200}, 48}, enough = {1, "person", {300, 200}, 62};
  EXPECT_LT(truth_of(0, {small}).objects[0].pixels, 600);
  EXPECT_GT(truth_of(0, {enough}).objects[0].pixels, 600);
  EXPECT_FALSE(ever_seen(small));
  EXPECT_TRUE(ever_seen(enough));
  // The same in an image of half the size, with a quarter of the pixels.
  const Figure half_small = {1, "person", {300, 200}, 46},
               half_enough = {1, "person", {300, 200}, 66};
  EXPECT_LT(truth_of(0, {half_small}, kSmallImage).objects[0].pixels, 150);
  EXPECT_GT(truth_of(0, {half_enough}, kSmallImage).objects[0].pixels, 150);
  EXPECT_FALSE(ever_seen(half_small, kSmallImage));
  EXPECT_TRUE(ever_seen(half_enough, kSmallImage));

  EXPECT_FALSE(ever_seen({1, "person", {300, 200}, 300, 0.49}));
  EXPECT_TRUE(ever_seen({1, "person", {300, 200}, 300, 0.51}));
  EXPECT_FALSE(ever_seen({13, "box", {300, 200}, 300}));
}

TEST(DetectionFaults, ShiftBoxesByAFewPixels) {
  DetectionFaultOptions options = no_faults();
  options.box_shift_px = 4;
  const DetectionFaults faults(5, options);
  double most = 0, sum = 0;
  for (std::uint32_t frame = 0; frame < 200; ++frame) {
    const FrameTruth truth = walker(frame);
    const FrameDetections detections = faults.apply(truth);
    ASSERT_EQ(detections.objects.size(), 1U);
    const PixelBox& found = detections.objects[0].box;
    const PixelBox& own = truth.objects[0].box;
    for (const double shift :
         {found.x0 - own.x0, found.y0 - own.y0, found.x1 - own.x1, found.y1 - own.y1}) {
      most = std::max(most, std::abs(shift));
      sum += shift;
    }
  }
  EXPECT_EQ(most, 4.0);
  EXPECT_NEAR(sum / 800, 0.0, 0.3) << "to every side alike";
}

TEST(DetectionFaults, ScoresAreLowerAndVary) {
  const DetectionFaults faults(5, no_faults());
  std::set<float> scores;
  double sum = 0;
  for (std::uint32_t frame = 0; frame < 200; ++frame) {
    const float score = faults.apply(walker(frame, kSmallImage)).objects.at(0).score;
    EXPECT_GE(score, 0.3F);
    EXPECT_LE(score, 0.99F);
    scores.insert(score);
    sum += score;
  }
  EXPECT_GT(scores.size(), 150U);
  EXPECT_NEAR(sum / 200, 0.83, 0.05);
}

TEST(DetectionFaults, SometimesReportTwiceOrWhatIsNotThere) {
  DetectionFaultOptions options = no_faults();
  options.duplicate_rate = 0.25;
  int twice = 0;
  for (std::uint32_t frame = 0; frame < 400; ++frame) {
    const FrameDetections detections =
        DetectionFaults(5, options).apply(walker(frame, kSmallImage));
    if (detections.objects.size() == 1) continue;
    ++twice;
    ASSERT_EQ(detections.objects.size(), 2U);
    EXPECT_GT(cv::countNonZero(detections.mask.mat == 1), 0);
    EXPECT_EQ(cv::countNonZero(detections.mask.mat == 2), 0) << "a mere box";
    EXPECT_LT(detections.objects[1].score, detections.objects[0].score);
  }
  EXPECT_NEAR(twice / 400.0, 0.25, 0.07);

  options = no_faults();
  options.false_rate = 0.25;
  int false_ones = 0;
  for (std::uint32_t frame = 0; frame < 2000; ++frame) {
    const FrameDetections detections =
        DetectionFaults(5, options).apply(truth_of(frame, {}, kSmallImage));
    if (detections.objects.empty()) continue;
    ++false_ones;
    EXPECT_GT(cv::countNonZero(detections.mask.mat == 1), 100);
    EXPECT_LE(detections.objects[0].score, 0.5F);
  }
  EXPECT_NEAR(false_ones / 2000.0, 0.25, 0.07);
}

TEST(DetectionFaults, AreAFunctionOfSeedAndFrame) {
  const DetectionFaults faults(1), again(1), other(2);
  std::vector<FrameDetections> forward;
  for (std::uint32_t frame = 0; frame < 30; ++frame)
    forward.push_back(faults.apply(walker(frame, kSmallImage)));
  int different = 0;
  for (std::uint32_t frame = 30; frame-- > 0;) {
    EXPECT_TRUE(same(again.apply(walker(frame, kSmallImage)), forward[frame]));
    different += same(other.apply(walker(frame, kSmallImage)), forward[frame]) ? 0 : 1;
  }
  EXPECT_GT(different, 25);
}

TEST(DetectionFaults, OfOneObjectDoNotDependOnOthers) {
  DetectionFaultOptions options;
  options.false_rate = 0;
  options.duplicate_rate = 0;
  const DetectionFaults faults(1, options);
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    const Figure person = {1, "person", {150, 240}, 300}, chair = {10, "chair", {500, 240}, 300};
    const FrameDetections alone = faults.apply(truth_of(frame, {person}));
    const FrameDetections both = faults.apply(truth_of(frame, {chair, person}));
    const auto found = std::ranges::find(both.objects, "person", &DetectedObject::class_name);
    ASSERT_EQ(found == both.objects.end(), alone.objects.empty());
    if (alone.objects.empty()) continue;
    EXPECT_EQ(found->box, alone.objects[0].box);
    EXPECT_EQ(overlap(both.mask.mat == found->id, alone.mask.mat == 1), 1.0);
  }
}

// Masks, ids and boxes are accepted by the reader of detections, also at borders.
TEST(DetectionFaults, AreWrittenAndReadBack) {
  const TemporaryFolder folder;
  DetectionFaultOptions options;
  options.duplicate_rate = options.false_rate = 0.5;
  const DetectionFaults faults(1, options);
  DetectionsWriter writer(folder.path(), kImage);
  std::vector<FrameDetections> written;
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    const double x = 15.0 * frame - 100.0;
    const FrameTruth truth = truth_of(frame,
                                      {{1, "person", {x, 240}, 600},
                                       {2, "person", {640 - x, 100}, 500},
                                       {10, "chair", {320, 470}, 150}});
    written.push_back(faults.apply(truth));
    writer.add(written.back());
    float previous = 1.F;
    for (std::size_t i = 0; i < written.back().objects.size(); ++i) {
      EXPECT_EQ(written.back().objects[i].id, static_cast<int>(i) + 1);
      EXPECT_LE(written.back().objects[i].score, previous);
      previous = written.back().objects[i].score;
    }
  }
  writer.finish();
  const DetectionsFolder read = DetectionsFolder::open(folder.path(), kImage);
  for (const FrameDetections& frame : written) EXPECT_TRUE(same(read.at(frame.stamp), frame));
}

}  // namespace
}  // namespace stillmap
