// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/export_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

NetworkSignature with_input(const TensorShape& shape, const std::string& names = "") {
  return {{{"image", shape}}, {}, names};
}

NetworkExport identify(const std::vector<TensorShape>& outputs, const std::string& names = "") {
  return identify_export(with_input({1, 3, 8, 8}, names), outputs);
}

TEST(ImageInputShape, GivenOrOpen) {
  const cv::Size image(640, 470);
  EXPECT_THAT(image_input_shape(with_input({1, 3, 416, 320}), image), ElementsAre(1, 3, 416, 320));
  EXPECT_THAT(image_input_shape(with_input({-1, 256, 128, 3}), image), ElementsAre(1, 256, 128, 3));
  EXPECT_THAT(image_input_shape(with_input({-1, 3, -1, -1}), image), ElementsAre(1, 3, 480, 640));
}

TEST(ImageInputShape, RefusesOtherInputs) {
  for (const TensorShape& shape : {TensorShape{1, 4, 8, 8},
                                   TensorShape{3, 8, 8},
                                   TensorShape{2, 3, 8, 8},
                                   TensorShape{1, 3, 9000, 8}}) {
    EXPECT_THAT(error_of([&] {
                  (void)image_input_shape(with_input(shape), {640, 480});
                }),
                HasSubstr("expected"));
  }
  EXPECT_THAT(error_of([] {
                (void)image_input_shape(NetworkSignature(), {640, 480});
              }),
              HasSubstr("expected one image"));
}

TEST(IdentifyExport, ClassMap) {
  const NetworkExport voc = identify({{1, 21, 320, 416}});
  EXPECT_EQ(voc.kind, ExportKind::kClassMap);
  ASSERT_EQ(voc.names.size(), 21U);
  EXPECT_EQ(voc.names[0], "background");
  EXPECT_EQ(voc.names[15], "person");
  EXPECT_EQ(voc.names[20], "tvmonitor");
  EXPECT_EQ(identify({{1, 320, 416, 21}}).kind, ExportKind::kClassMap);
  EXPECT_EQ(identify({{1, 320, 416}}).names.size(), 21U);
  EXPECT_THAT(identify({{1, 2, 320, 416}}, "['none', 'person']").names,
              ElementsAre("none", "person"));
}

TEST(IdentifyExport, Yolo) {
  const NetworkExport v5 = identify({{1, 25200, 117}, {1, 32, 160, 160}});
  EXPECT_EQ(v5.kind, ExportKind::kYoloRows);
  EXPECT_EQ(v5.names.size(), 80U);
  EXPECT_EQ(v5.names[0], "person");
  const NetworkExport v8 = identify({{1, 32, 160, 160}, {1, 116, 8400}});
  EXPECT_EQ(v8.kind, ExportKind::kYoloColumns);
  EXPECT_THAT(v8.outputs, ElementsAre(1, 0));
  EXPECT_THAT(identify({{1, 38, 8400}, {1, 32, 160, 160}}, "{0: 'box', 1: 'hand'}").names,
              ElementsAre("box", "hand"));
}

TEST(IdentifyExport, BlitzNet) {
  const NetworkExport ssd = identify({{1, 21, 75, 75}, {1, 900, 21}, {1, 900, 4}, {900, 4}});
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
  const NetworkExport centernet = identify({{1, 128, 128, 4}, {1, 128, 128, 80}});
  EXPECT_EQ(centernet.kind, ExportKind::kCenterNet);
  EXPECT_THAT(centernet.outputs, ElementsAre(1, 0));
}

TEST(IdentifyExport, RefusesWhatIsNotKnown) {
  EXPECT_THAT(error_of([] {
                (void)identify({{1, 1000}, {3, 3, 3}, {1}});
              }),
              HasSubstr("outputs 1x1000, 3x3x3, 1: expected"));
  EXPECT_THAT(error_of([] { (void)identify({}); }), HasSubstr("expected"));
  EXPECT_THAT(error_of([] {
                (void)identify({{1, 7, 320, 416}});
              }),
              HasSubstr("7 classes without their names"));
}

TEST(QuotedWords, OfListsAndDictionaries) {
  EXPECT_THAT(quoted_words("{0: 'person', 1: \"driver's seat\"}"),
              ElementsAre("person", "driver's seat"));
  EXPECT_THAT(quoted_words("['a', 'b"), ElementsAre("a"));
  EXPECT_THAT(quoted_words(""), testing::IsEmpty());
}

}  // namespace
}  // namespace stillmap
