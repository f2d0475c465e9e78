// SPDX-License-Identifier: Apache-2.0
// The segmenters, with functions in place of networks.
#include "stillmap/perception/segmentation/network_segmenter.hpp"

#include <functional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/files.hpp"
#include "tests/support/tensors.hpp"

namespace stillmap {
namespace {

using Run = std::function<std::vector<Tensor>(const Tensor&)>;

class FunctionNetwork : public Network {
 public:
  FunctionNetwork(TensorShape input, Run run) : run_(std::move(run)) {
    signature_.inputs = {{"image", std::move(input)}};
  }
  [[nodiscard]] const NetworkSignature& signature() const override { return signature_; }
  [[nodiscard]] std::vector<Tensor> run(const Tensor& input) const override { return run_(input); }

 private:
  NetworkSignature signature_;
  Run run_;
};

const cv::Size kSmallImage(64, 48);
const Stamp kStamp{2.5, "2.5"};

// White where a person stands, black elsewhere.
ColorImage person_at(cv::Rect place) {
  cv::Mat3b image = cv::Mat3b::zeros(kSmallImage);
  image(place).setTo(cv::Scalar(255, 255, 255));
  return ColorImage(image);
}

// A network that finds a person where its input, however normalised, is positive.
Tensor person_where_positive(const Tensor& input) {
  const std::size_t area = input.values.size() / 3;
  Tensor logits = zeros({1, 21, input.shape[2], input.shape[3]});
  for (std::size_t i = 0; i < area; ++i) {
    logits.values[(input.values[i] > 0 ? 15 : 0) * area + i] = 5;
  }
  return logits;
}

TEST(NetworkSegmenter, ClassMapBecomesObjects) {
  const NetworkSegmenter segmenter(
      std::make_unique<FunctionNetwork>(
          TensorShape{1, 3, 96, 128},
          [](const Tensor& input) { return std::vector{person_where_positive(input)}; }),
      kSmallImage);
  const cv::Rect place(10, 8, 24, 30);
  const FrameDetections found = segmenter.segment(person_at(place), kStamp);
  EXPECT_EQ(found.stamp.text, "2.5");
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_EQ(found.objects[0].class_name, "person");
  EXPECT_EQ(found.objects[0].box, (PixelBox{10, 8, 34, 38}));
  cv::Mat1b expected = cv::Mat1b::zeros(kSmallImage);
  expected(place).setTo(1);
  EXPECT_EQ(cv::countNonZero(found.mask.mat != expected), 0);
}

// NanoDet with one cell of 64 pixels: at its middle a person or, with label 1, another thing, whose
// box reaches half a stride to each side.
// Only the first image of the batch is white at the person.
TEST(NetworkSegmenter, GivesABatchItsFirstImage) {
  const NetworkSegmenter segmenter(
      std::make_unique<FunctionNetwork>(
          TensorShape{3, 3, 96, 128},
          [](const Tensor& input) {
            Tensor first = input;
            first.shape[0] = 1;
            first.values.resize(input.values.size() / 3);
            Tensor all = person_where_positive(first);
            EXPECT_EQ(cv::norm(cv::Mat(input.values).rowRange(3 * 96 * 128, 9 * 96 * 128)), 0);
            all.shape[0] = 3;
            all.values.resize(all.values.size() * 3, 9.0F);
            return std::vector{all};
          }),
      kSmallImage);
  const FrameDetections found = segmenter.segment(person_at({10, 8, 24, 30}), kStamp);
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_EQ(found.objects[0].box, (PixelBox{10, 8, 34, 38}));
}

// Half an image of 64x48 on 64x64 with 8 rows of padding above: rows (x0, y0, x1, y1, score,
// class).
TEST(NetworkSegmenter, EndToEndBoxesInPixelsOfTheImage) {
  const NetworkSegmenter segmenter(
      std::make_unique<FunctionNetwork>(
          TensorShape{1, 3, 64, 64},
          [](const Tensor&) {
            return std::vector{Tensor{{1, 2, 6}, {10, 18, 30, 48, 0.9F, 0, 0, 0, 0, 0, 0, 0}}};
          }),
      kSmallImage);
  const FrameDetections found = segmenter.segment(person_at({0, 0, 4, 4}), kStamp);
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_EQ(found.objects[0].class_name, "person");
  EXPECT_EQ(found.objects[0].box, (PixelBox{10, 10, 30, 40}));
  EXPECT_TRUE(found.mask.mat.empty());
}

Run nanodet(float person, float other) {
  return [=](const Tensor&) {
    Tensor scores = zeros({1, 1, 80}), fine_scores = zeros({1, 4, 80});
    scores.values[0] = person;
    scores.values[1] = other;
    Tensor boxes = zeros({1, 1, 8}), fine_boxes = zeros({1, 4, 8});
    return std::vector{fine_scores, fine_boxes, scores, boxes};
  };
}

// A matting network that sees a person where its crop is white.
std::vector<Tensor> matting(const Tensor& input) {
  Tensor output = zeros({1, 32, 32, 1});
  for (std::size_t i = 0; i < output.values.size(); ++i) output.values[i] = input.values[i * 3];
  return {output};
}

PersonSegmenter person_segmenter(float person, float other) {
  return PersonSegmenter(
      std::make_unique<FunctionNetwork>(TensorShape{1, 3, 64, 64}, nanodet(person, other)),
      std::make_unique<FunctionNetwork>(TensorShape{1, 32, 32, 3}, matting),
      0.5F,
      kSmallImage);
}

// The image fills the 64x64 input except 8 rows above and below: the box is the whole image.
TEST(PersonSegmenter, MaskIsOfTheMattingNetwork) {
  const cv::Rect place(16, 16, 32, 16);
  const FrameDetections found = person_segmenter(0.9F, 0).segment(person_at(place), kStamp);
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_EQ(found.objects[0].class_name, "person");
  EXPECT_EQ(found.objects[0].pixel_source, PixelSource::kRoughNetwork);
  EXPECT_EQ(found.objects[0].box, (PixelBox{0, 0, 64, 48}));
  cv::Mat1b expected = cv::Mat1b::zeros(kSmallImage);
  expected(place).setTo(1);
  // A pixel of the crop holds two of the image: the outline is accurate to one pixel.
  EXPECT_LT(cv::countNonZero(found.mask.mat != expected), 2 * (32 + 16) + 4);
  EXPECT_GT(cv::countNonZero(found.mask.mat), 30 * 14);
}

TEST(PersonSegmenter, OtherThingsAreBoxes) {
  const FrameDetections found =
      person_segmenter(0, 0.9F).segment(person_at({16, 16, 32, 16}), kStamp);
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_EQ(found.objects[0].class_name, "bicycle");
  EXPECT_TRUE(found.mask.mat.empty());
}

// Backs before the camera often have no pixels, although the detector is sure of them.
TEST(PersonSegmenter, APersonWithoutPixelsIsABoxWhereTheScoreIsHighAndElseNone) {
  const ColorImage nobody = person_at({0, 0, 2, 2});
  const FrameDetections sure = person_segmenter(0.9F, 0).segment(nobody, kStamp);
  ASSERT_EQ(sure.objects.size(), 1U);
  EXPECT_EQ(sure.objects[0].pixel_source, PixelSource::kNetwork);
  EXPECT_TRUE(sure.mask.mat.empty());
  EXPECT_THAT(person_segmenter(0.25F, 0).segment(nobody, kStamp).objects, testing::IsEmpty());
}

TEST(PersonSegmenter, WeakPeopleCountOtherThingsDoNot) {
  EXPECT_THAT(person_segmenter(0.25F, 0.25F).segment(person_at({16, 16, 32, 16}), kStamp).objects,
              testing::ElementsAre(testing::Field(&DetectedObject::class_name, "person")));
}

}  // namespace
}  // namespace stillmap
