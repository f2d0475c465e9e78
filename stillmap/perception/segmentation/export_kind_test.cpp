// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/export_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.hpp"
#include "tests/support/tensors.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const cv::Size kInput(640, 640);

NetworkSignature with_input(const TensorShape& shape, const std::string& names = "") {
  return {{{"image", shape}}, {}, names, ""};
}

// Outputs of these shapes that hold zeros.
std::vector<Tensor> all_zeros(const std::vector<TensorShape>& shapes) {
  std::vector<Tensor> outputs;
  for (const TensorShape& shape : shapes) outputs.push_back(zeros(shape));
  return outputs;
}

NetworkExport identify(const std::vector<TensorShape>& outputs,
                       const std::string& names = "",
                       cv::Size input = kInput) {
  return identify_export(with_input({1, 3, 8, 8}, names), all_zeros(outputs), input);
}

std::string refusal(const std::vector<TensorShape>& outputs, const std::string& names = "") {
  return error_of([&] { (void)identify(outputs, names); });
}

// The refusal of a network's only output by its values.
std::string refusal_of_values(const Tensor& output, const std::string& names = "") {
  return error_of([&] {
    (void)identify_export(with_input({1, 3, 640, 640}, names), {output}, kInput);
  });
}

TEST(ImageInputShape, GivenOrOpen) {
  const cv::Size image(640, 470);
  EXPECT_THAT(image_input_shape(with_input({1, 3, 416, 320}), image), ElementsAre(1, 3, 416, 320));
  EXPECT_THAT(image_input_shape(with_input({-1, 256, 128, 3}), image), ElementsAre(1, 256, 128, 3));
  EXPECT_THAT(image_input_shape(with_input({-1, 3, -1, -1}), image), ElementsAre(1, 3, 480, 640));
  EXPECT_THAT(image_input_shape(with_input({4, 3, 64, 64}), image), ElementsAre(4, 3, 64, 64));
}

TEST(ImageInputShape, RefusesOtherInputs) {
  for (const TensorShape& shape : {TensorShape{1, 4, 8, 8},
                                   TensorShape{3, 8, 8},
                                   TensorShape{65, 3, 8, 8},
                                   TensorShape{64, 3, 8000, 8000},
                                   TensorShape{1, 3, 9000, 8}}) {
    EXPECT_THAT(error_of([&] {
                  (void)image_input_shape(with_input(shape), {640, 480});
                }),
                HasSubstr("expected"));
  }
  EXPECT_THAT(error_of([] {
                (void)image_input_shape(NetworkSignature(), {640, 480});
              }),
              HasSubstr("the inputs none: expected one image"));
}

TEST(IdentifyExport, ClassMap) {
  const cv::Size input(416, 320);
  const NetworkExport voc = identify({{1, 21, 320, 416}}, "", input);
  EXPECT_EQ(voc.kind, ExportKind::kClassMap);
  ASSERT_EQ(voc.names.size(), 21U);
  EXPECT_EQ(voc.names[0], "background");
  EXPECT_EQ(voc.names[15], "person");
  EXPECT_EQ(voc.names[20], "tvmonitor");
  EXPECT_FALSE(voc.channels_last);
  const NetworkExport last = identify({{1, 320, 416, 21}}, "", input);
  EXPECT_EQ(last.kind, ExportKind::kClassMap);
  EXPECT_TRUE(last.channels_last);
  EXPECT_EQ(identify({{1, 320, 416}}, "", input).names.size(), 21U);
  EXPECT_THAT(identify({{1, 2, 320, 416}}, "['none', 'person']", input).names,
              ElementsAre("none", "person"));
  EXPECT_THAT(identify({{1, 2, 320, 416}}, "['person']", input).names,
              ElementsAre("background", "person"));
}

// More classes than the coarse map has rows: the plane is recognised by the input's aspect ratio.
TEST(IdentifyExport, ClassMapOfManyClasses) {
  std::string names;
  for (int i = 0; i < 150; ++i) names += "'c" + std::to_string(i) + "', ";
  const NetworkExport first = identify({{1, 150, 128, 128}}, names, {512, 512});
  EXPECT_EQ(first.names.size(), 150U);
  EXPECT_FALSE(first.channels_last);
  EXPECT_TRUE(identify({{1, 128, 128, 150}}, names, {512, 512}).channels_last);
}

TEST(IdentifyExport, YoloWithMasks) {
  const NetworkExport v5 = identify({{1, 25200, 117}, {1, 32, 160, 160}});
  EXPECT_EQ(v5.kind, ExportKind::kYoloRows);
  EXPECT_EQ(v5.names.size(), 80U);
  EXPECT_EQ(v5.names[0], "person");
  const NetworkExport v8 = identify({{1, 32, 160, 160}, {1, 116, 8400}});
  EXPECT_EQ(v8.kind, ExportKind::kYoloColumns);
  EXPECT_THAT(v8.outputs, ElementsAre(1, 0));
  EXPECT_THAT(identify({{1, 38, 8400}, {1, 32, 160, 160}}, "{0: 'box', 1: 'hand'}").names,
              ElementsAre("box", "hand"));
  const NetworkExport end_to_end = identify({{1, 300, 38}, {1, 32, 160, 160}});
  EXPECT_EQ(end_to_end.kind, ExportKind::kYoloFinal);
  EXPECT_EQ(end_to_end.names.size(), 80U);
}

TEST(IdentifyExport, YoloWithBoxesOnly) {
  EXPECT_EQ(identify({{1, 25200, 85}}).kind, ExportKind::kYoloRows);
  EXPECT_EQ(identify({{1, 84, 8400}}).kind, ExportKind::kYoloColumns);
  EXPECT_EQ(identify({{1, 84, 84}}).kind, ExportKind::kYoloColumns);  // all cells of 64x64
  EXPECT_EQ(identify({{1, 300, 6}}).kind, ExportKind::kYoloFinal);
  EXPECT_EQ(identify({{1, 0, 6}}).kind, ExportKind::kYoloFinal);
  EXPECT_EQ(identify({{1, 300, 6}}).names.size(), 80U);
}

TEST(IdentifyExport, OneClass) {
  const std::string names = "{0: 'person'}";
  EXPECT_EQ(identify({{1, 25200, 6}}, names).kind, ExportKind::kYoloRows);
  EXPECT_EQ(identify({{1, 5, 8400}}, names).kind, ExportKind::kYoloColumns);
  EXPECT_EQ(identify({{1, 300, 6}}, names).kind, ExportKind::kYoloFinal);
  EXPECT_EQ(identify({{1, 300, 5}}, names).kind, ExportKind::kDetr);
  EXPECT_THAT(identify({{1, 5, 8400}}, names).names, ElementsAre("person"));
  EXPECT_THAT(refusal({{1, 5, 8400}}), HasSubstr("1 classes without their names"));
}

TEST(IdentifyExport, RtDetr) {
  EXPECT_EQ(identify({{1, 300, 84}}).kind, ExportKind::kDetr);
  const NetworkExport two = identify({{1, 300, 80}, {1, 300, 4}});
  EXPECT_EQ(two.kind, ExportKind::kDetr);
  EXPECT_THAT(two.outputs, ElementsAre(1, 0));
}

// 1xNx6 are rows of the end-to-end kind, or two classes' scores: the sixth column tells.
TEST(IdentifyExport, ValuesTellWhereShapesDoNot) {
  const NetworkSignature two_classes = with_input({1, 3, 640, 640}, "['a', 'b']");
  Tensor rows{{1, 2, 6}, {100, 100, 200, 300, 0.9F, 1, 0, 0, 0, 0, 0, 0}};
  EXPECT_EQ(identify_export(two_classes, {rows}, kInput).kind, ExportKind::kYoloFinal);
  rows.values = {0.5F, 0.5F, 0.1F, 0.2F, 0.9F, 0.2F, 0.1F, 0.1F, 0.1F, 0.1F, 0.3F, 0.4F};
  EXPECT_EQ(identify_export(two_classes, {rows}, kInput).kind, ExportKind::kDetr);
}

TEST(IdentifyExport, BlitzNet) {
  const NetworkExport ssd =
      identify({{1, 21, 75, 75}, {1, 900, 21}, {1, 900, 4}, {900, 4}}, "", {300, 300});
  EXPECT_EQ(ssd.kind, ExportKind::kSsd);
  EXPECT_THAT(ssd.outputs, ElementsAre(3, 2, 1, 0));
  EXPECT_EQ(ssd.names[0], "background");
}

TEST(IdentifyExport, NanoDetByResolution) {
  const NetworkExport nanodet = identify(
      {{1, 676, 80}, {1, 169, 44}, {1, 2704, 80}, {1, 2704, 44}, {1, 676, 44}, {1, 169, 80}});
  EXPECT_EQ(nanodet.kind, ExportKind::kNanoDet);
  EXPECT_THAT(nanodet.outputs, ElementsAre(2, 3, 0, 4, 5, 1));
}

TEST(IdentifyExport, CenterNet) {
  const NetworkExport centernet = identify({{1, 128, 128, 4}, {1, 128, 128, 80}}, "", {512, 512});
  EXPECT_EQ(centernet.kind, ExportKind::kCenterNet);
  EXPECT_THAT(centernet.outputs, ElementsAre(1, 0));
}

TEST(IdentifyExport, RefusesWhatIsNotKnown) {
  EXPECT_THAT(refusal({{1, 1000}, {3, 3, 3}, {1}}),
              HasSubstr("outputs 1x1000, 3x3x3, 1: expected"));
  EXPECT_THAT(refusal(std::vector<TensorShape>()), HasSubstr("expected"));
  EXPECT_THAT(refusal({{1, 7, 320, 320}}), HasSubstr("7 classes without their names"));
  EXPECT_THAT(refusal({{1, 84, 8400}}, "['a', 'b', 'c']"),
              HasSubstr("80 classes with 3 names in its metadata entry 'names': expected 80"));
}

TEST(IdentifyExport, RefusesClassifiersOfWholeImages) {
  for (const TensorShape& shape :
       std::vector<TensorShape>{{1, 1000}, {1, 21}, {1, 21, 1, 1}, {1, 1, 1, 1000}, {1000}}) {
    EXPECT_THAT(refusal({shape}), HasSubstr(shape_text(shape) + ", as image classifiers have"));
  }
  EXPECT_THAT(refusal({{1, 21, 2, 2}}), HasSubstr("expected a class map"));  // no map's size
  for (const char* task : {"classify", "pose", "obb"}) {
    NetworkSignature signature = with_input({1, 3, 640, 640});
    signature.task = task;
    EXPECT_THAT(error_of([&] {
                  (void)identify_export(signature, all_zeros({{1, 84, 8400}}), kInput);
                }),
                HasSubstr("the task '" + std::string(task) + "'"));
  }
}

TEST(IdentifyExport, RefusesValuesThatAreNone) {
  Tensor columns = zeros({1, 84, 100});
  columns.values[400] = 7.5F;  // the first class of the first box
  EXPECT_THAT(refusal_of_values(columns), HasSubstr("a score of 7.5, expected 0 to 1"));
  columns.values[400] = 0.5F;
  for (const std::size_t a : {0U, 1U, 2U, 3U}) columns.values[a * 100] = 0.5F;
  EXPECT_THAT(refusal_of_values(columns), HasSubstr("all boxes lie in 0 to 1, expected pixels"));
  Tensor queries = zeros({1, 2, 84});
  queries.values[2] = 300;
  EXPECT_THAT(refusal_of_values(queries), HasSubstr("a side of a box at 300, expected shares"));
  Tensor rows = zeros({1, 2, 6});
  rows.values[5] = 0.5F;
  EXPECT_THAT(refusal_of_values(rows), HasSubstr("a class number of 0.5"));
  std::vector<Tensor> heat = all_zeros({{1, 160, 160, 80}, {1, 160, 160, 4}});
  heat[0].values[7] = -3;
  EXPECT_THAT(error_of([&] {
                (void)identify_export(with_input({1, 3, 640, 640}), heat, kInput);
              }),
              HasSubstr("a score of -3, expected 0 to 1"));
  Tensor labels = zeros({1, 160, 160});
  labels.values[9] = 0.25F;
  EXPECT_THAT(refusal_of_values(labels),
              HasSubstr("holds 0.25, expected whole numbers from 0 to 20"));
}

TEST(QuotedWords, OfListsAndDictionaries) {
  EXPECT_THAT(quoted_words("{0: 'person', 1: \"driver's seat\"}"),
              ElementsAre("person", "driver's seat"));
  EXPECT_THAT(quoted_words("['a', 'b"), ElementsAre("a"));
  EXPECT_THAT(quoted_words(""), testing::IsEmpty());
}

}  // namespace
}  // namespace stillmap
