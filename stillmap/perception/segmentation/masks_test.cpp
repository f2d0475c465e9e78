// SPDX-License-Identifier: Apache-2.0
// From a network's planes to the masks of objects, on small planes computed by hand.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/perception/segmentation/class_map.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/matting.hpp"
#include "stillmap/perception/segmentation/yolo.hpp"
#include "tests/support/files.hpp"
#include "tests/support/tensors.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

bool same(const cv::Mat1b& a, const cv::Mat1b& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

const std::vector<std::string> kNames = {"background", "person", "chair"};

// Logits of three classes on 6x4 pixels that give these labels.
Tensor logits_of(const cv::Mat1b& labels, bool channels_last) {
  const int area = static_cast<int>(labels.total());
  Tensor logits = zeros(channels_last ? TensorShape{1, labels.rows, labels.cols, 3}
                                      : TensorShape{1, 3, labels.rows, labels.cols});
  for (int i = 0; i < area; ++i) {
    const int label = labels(i / labels.cols, i % labels.cols);
    const int index = channels_last ? i * 3 + label : label * area + i;
    logits.values[static_cast<std::size_t>(index)] = std::log(8.0F);
  }
  return logits;
}

const cv::Mat1b kLabels =
    (cv::Mat1b(4, 6) << 1, 1, 0, 0, 2, 2, 1, 1, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 2, 2);

TEST(ClassMap, OfTheImagesSizeIsTheLargestLogit) {
  const InputPlacement whole = InputPlacement::stretch({6, 4}, {6, 4});
  for (const bool channels_last : {false, true}) {
    const Tensor logits = logits_of(kLabels, channels_last);
    const ClassMap map = decode_class_map(logits.view(), channels_last, whole, {6, 4});
    EXPECT_TRUE(same(map.labels, kLabels));
    EXPECT_NEAR(map.probability(0, 0), 0.8, 1e-6);  // 8 / (8 + 1 + 1)
  }
}

TEST(ClassMap, LabelsThemselves) {
  Tensor labels = zeros({1, 4, 6});
  std::ranges::copy(kLabels, labels.values.begin());
  const InputPlacement whole = InputPlacement::stretch({6, 4}, {6, 4});
  EXPECT_TRUE(same(decode_class_map(labels.view(), false, whole, {6, 4}).labels, kLabels));
}

// A vertical edge between two coarse pixels stays between them in the finer image.
TEST(ClassMap, EdgeOfACoarserMap) {
  const cv::Mat1b coarse = (cv::Mat1b(1, 2) << 1, 2);
  const Tensor logits = logits_of(coarse, false);
  const InputPlacement placement = InputPlacement::stretch({8, 2}, {4, 4});
  const cv::Mat1b expected = (cv::Mat1b(2, 8) << 1, 1, 1, 1, 2, 2, 2, 2, 1, 1, 1, 1, 2, 2, 2, 2);
  EXPECT_TRUE(same(decode_class_map(logits.view(), false, placement, {8, 2}).labels, expected));
}

TEST(ClassMap, RefusesOtherShapes) {
  const InputPlacement whole = InputPlacement::stretch({6, 4}, {6, 4});
  for (const TensorShape& shape : {TensorShape{300, 2, 2}, TensorShape{2, 3, 4, 6}}) {
    const Tensor output = zeros(shape);
    EXPECT_THAT(error_of([&] {
                  (void)decode_class_map(output.view(), false, whole, {6, 4});
                }),
                HasSubstr(shape_text(shape)));
  }
}

ClassMap known_map() {
  return {kLabels, cv::Mat1f(kLabels.size(), 0.5F)};
}

TEST(ObjectsOfClassMap, AreConnectedRegions) {
  const std::vector<FoundObject> objects =
      objects_of_class_map(known_map(), kNames, {.min_pixels = 3});
  ASSERT_EQ(objects.size(), 3U);  // the single pixel of a person is too small
  EXPECT_EQ(objects[0].class_name, "person");
  EXPECT_EQ(objects[0].box, (PixelBox{0, 0, 2, 2}));
  EXPECT_EQ(objects[0].score, 0.5F);
  EXPECT_EQ(objects[1].class_name, "chair");
  EXPECT_EQ(objects[1].box, (PixelBox{4, 0, 6, 2}));
  EXPECT_EQ(objects[2].box, (PixelBox{3, 3, 6, 4}));
  EXPECT_EQ(cv::countNonZero(objects[2].mask), 3);
}

TEST(WithClassPixels, AreThoseOfTheClassInTheBox) {
  const std::vector<FoundObject> boxes = {{"chair", 0.9F, {3, 0, 5, 4}, {}, {}},
                                          {"dog", 0.8F, {0, 0, 6, 4}, {}, {}}};
  const std::vector<FoundObject> objects = with_class_pixels(boxes, known_map(), kNames);
  EXPECT_EQ(objects[0].region, cv::Rect(3, 0, 2, 4));
  const cv::Mat1b expected = (cv::Mat1b(4, 2) << 0, 255, 0, 255, 0, 0, 255, 255);
  EXPECT_TRUE(same(objects[0].mask, expected));
  EXPECT_TRUE(objects[1].mask.empty());  // the map has no class dog
}

TEST(CropSquare, ByHand) {
  EXPECT_EQ(crop_square({10, 20, 30, 60}, 1.5), (PixelBox{-10, 10, 50, 70}));
}

// The left half of the crop is a person; the box lies in the crop's middle.
TEST(WithMatting, IsClippedToTheBox) {
  Tensor output = zeros({1, 8, 8, 1});
  for (std::size_t i = 0; i < 64; ++i) output.values[i] = i % 8 < 4 ? 0.9F : 0.1F;
  FoundObject person{"person", 0.9F, {6, 6, 14, 14}, {}, {}};
  const InputPlacement crop = InputPlacement::crop(crop_square(person.box, 2), {8, 8});
  person = with_matting(person, output.view(), 0.5F, crop, {100, 100});
  EXPECT_EQ(person.region, cv::Rect(6, 6, 8, 8));
  cv::Mat1b expected = cv::Mat1b::zeros(8, 8);
  expected(cv::Rect(0, 0, 4, 8)).setTo(255);
  EXPECT_TRUE(same(person.mask, expected));
  const Tensor wrong = zeros({1, 8, 8, 3});
  EXPECT_THAT(error_of([&] {
                (void)with_matting(person, wrong.view(), 0.5F, crop, {100, 100});
              }),
              HasSubstr("1x8x8x3"));
}

// Two boxes, one class more than the prototypes: {x, y, w, h, [object], a, b, coefficients p, q}.
struct YoloCase {
  std::vector<float> first{8, 8, 8, 4}, second{20, 16, 8, 8};
  Tensor prototypes = zeros({1, 2, 8, 8});  // for an input of 32x32

  YoloCase() {
    for (std::size_t i = 0; i < 64; ++i) {
      prototypes.values[i] = i % 8 < 2 ? 1.0F : -1.0F;       // the left quarter
      prototypes.values[64 + i] = i / 8 < 4 ? 1.0F : -1.0F;  // the upper half
    }
  }

  [[nodiscard]] Tensor rows() const {
    Tensor boxes{{1, 12, 9}, {}};
    std::vector<float> row = first;
    row.insert(row.end(), {0.5F, 0.2F, 0.8F, 1, 0});
    boxes.values = row;
    row = second;
    row.insert(row.end(), {1, 0.9F, 0.1F, 0, -1});
    boxes.values.insert(boxes.values.end(), row.begin(), row.end());
    boxes.values.resize(12 * 9);
    return boxes;
  }

  // The same without the score that there is an object, which is in the classes' scores instead.
  [[nodiscard]] Tensor columns() const {
    const Tensor by_row = rows();
    Tensor boxes = zeros({1, 8, 12});
    for (std::size_t box = 0; box < 12; ++box) {
      const float* const row = &by_row.values[box * 9];
      for (std::size_t a = 0; a < 8; ++a) {
        const float value = a < 4 ? row[a] : a < 6 ? row[4] * row[a + 1] : row[a + 1];
        boxes.values[a * 12 + box] = value;
      }
    }
    return boxes;
  }
};

void expect_yolo(const YoloOutputs& outputs) {
  const std::vector<Candidate> found = decode_yolo_boxes(outputs, 2, 0.3F);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].label, 1);
  EXPECT_FLOAT_EQ(found[0].score, 0.4F);
  EXPECT_EQ(found[0].box, (PixelBox{4, 6, 12, 10}));
  EXPECT_EQ(found[1].label, 0);
  EXPECT_FLOAT_EQ(found[1].score, 0.9F);

  // The image is half the input's size.
  const std::vector<FoundObject> objects = yolo_objects(
      outputs, found, {"person", "chair"}, InputPlacement::stretch({16, 16}, {32, 32}), {16, 16});
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].class_name, "chair");
  EXPECT_EQ(objects[0].region, cv::Rect(2, 3, 4, 2));
  // The left quarter ends at column 4 of the image, two columns into the box.
  const cv::Mat1b left = (cv::Mat1b(2, 4) << 255, 255, 0, 0, 255, 255, 0, 0);
  EXPECT_TRUE(same(objects[0].mask, left));
  // The negated upper half: from row 8 of the image, which is two rows into the box.
  EXPECT_EQ(objects[1].region, cv::Rect(8, 6, 4, 4));
  cv::Mat1b lower = cv::Mat1b::zeros(4, 4);
  lower.rowRange(2, 4).setTo(255);
  EXPECT_TRUE(same(objects[1].mask, lower));
}

TEST(Yolo, Rows) {
  const YoloCase yolo;
  const Tensor boxes = yolo.rows();
  expect_yolo({YoloLayout::kRows, boxes.view(), yolo.prototypes.view()});
}

TEST(Yolo, Columns) {
  const YoloCase yolo;
  const Tensor boxes = yolo.columns();
  expect_yolo({YoloLayout::kColumns, boxes.view(), yolo.prototypes.view()});
}

TEST(Yolo, EndToEnd) {
  const YoloCase yolo;
  Tensor boxes = zeros({1, 3, 8});
  // {x0, y0, x1, y1, score, class, coefficients p, q}; the last row holds nothing.
  boxes.values = {4,  6,  12, 10, 0.4F, 1,  1, 0,   //
                  16, 12, 24, 20, 0.9F, 0,  0, -1,  //
                  0,  0,  0,  0,  0,    -1, 0, 0};
  expect_yolo({YoloLayout::kFinal, boxes.view(), yolo.prototypes.view()});
}

// Networks that suppress overlaps themselves may give as many rows as there are objects.
TEST(Yolo, EndToEndWithoutObjects) {
  const Tensor none{{1, 0, 6}, {}};
  EXPECT_THAT(decode_yolo_boxes({YoloLayout::kFinal, none.view(), {}}, 80, 0.3F),
              testing::IsEmpty());
}

TEST(Yolo, WithoutPrototypesBoxesAlone) {
  // One class: {x, y, w, h, objectness, class} and {x, y, w, h, class}.
  const Tensor rows{{1, 2, 6}, {8, 8, 8, 4, 0.5F, 0.8F, 1, 1, 1, 1, 0.1F, 1}};
  const Tensor columns{{1, 5, 2}, {8, 1, 8, 1, 8, 1, 4, 1, 0.4F, 0.1F}};
  for (const YoloOutputs& outputs : {YoloOutputs{YoloLayout::kRows, rows.view(), {}},
                                     YoloOutputs{YoloLayout::kColumns, columns.view(), {}}}) {
    const std::vector<Candidate> found = decode_yolo_boxes(outputs, 1, 0.3F);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FLOAT_EQ(found[0].score, 0.4F);
    const std::vector<FoundObject> objects = yolo_objects(
        outputs, found, {"person"}, InputPlacement::stretch({16, 16}, {32, 32}), {16, 16});
    ASSERT_EQ(objects.size(), 1U);
    EXPECT_EQ(objects[0].box, (PixelBox{2, 3, 6, 5}));
    EXPECT_TRUE(objects[0].mask.empty());
  }
}

TEST(Yolo, RefusesScoresAndClassesThatAreNone) {
  const auto refusal = [](std::vector<float> row) {
    const Tensor boxes{{1, 1, 6}, std::move(row)};
    return error_of([&] {
      (void)decode_yolo_boxes({YoloLayout::kFinal, boxes.view(), {}}, 2, 0.3F);
    });
  };
  EXPECT_THAT(refusal({0, 0, 5, 5, 1.5F, 0}), HasSubstr("a score of 1.5, expected 0 to 1"));
  EXPECT_THAT(refusal({0, 0, 5, 5, 0.9F, 2}), HasSubstr("a class number of 2, expected"));
  EXPECT_THAT(refusal({0, 0, 5, 5, 0.9F, std::nanf("")}), HasSubstr("a class number of nan"));
}

TEST(Yolo, RefusesOtherShapes) {
  const YoloCase yolo;
  const Tensor boxes = zeros({1, 6, 12});
  EXPECT_THAT(error_of([&] {
                (void)decode_yolo_boxes(
                    {YoloLayout::kColumns, boxes.view(), yolo.prototypes.view()}, 2, 0.3F);
              }),
              HasSubstr("1x6x12 and 1x2x8x8"));
}

TEST(AssembleDetections, BetterObjectHasThePixel) {
  const cv::Mat1b all(2, 2, std::uint8_t{255});
  const FrameDetections frame =
      assemble_detections({1.5, "1.5"},
                          {4, 3},
                          {{"sofa", 0.5F, {0, 0, 2, 2}, {0, 0, 2, 2}, all},
                           {"person", 0.9F, {1, 1, 3.5, 9}, {1, 1, 2, 2}, all},
                           {"chair", 0.8F, {9, 9, 12, 12}, {}, {}}});  // out of the image
  EXPECT_EQ(frame.stamp.text, "1.5");
  ASSERT_EQ(frame.objects.size(), 2U);
  EXPECT_EQ(frame.objects[0], (DetectedObject{1, "person", 0.9F, {1, 1, 3.5, 3}}));
  EXPECT_EQ(frame.objects[1], (DetectedObject{2, "couch", 0.5F, {0, 0, 2, 2}}));
  const cv::Mat1b expected = (cv::Mat1b(3, 4) << 2, 2, 0, 0, 2, 1, 1, 0, 0, 1, 1, 0);
  EXPECT_TRUE(same(frame.mask.mat, expected));
}

TEST(AssembleDetections, NoPixelsNoMask) {
  const FrameDetections frame =
      assemble_detections({1, "1"}, {4, 3}, {{"cup", 2.0F, {0, 0, 2, 2}, {}, {}}});
  EXPECT_TRUE(frame.mask.mat.empty());
  EXPECT_EQ(frame.objects.at(0).score, 1.0F);
}

TEST(AssembleDetections, AtMost255) {
  const FrameDetections frame = assemble_detections(
      {1, "1"}, {4, 3}, std::vector<FoundObject>(300, {"cup", 0.5F, {0, 0, 2, 2}, {}, {}}));
  EXPECT_EQ(frame.objects.size(), 255U);
  EXPECT_EQ(frame.objects.back().id, 255);
}

}  // namespace
}  // namespace stillmap
