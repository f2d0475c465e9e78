// SPDX-License-Identifier: Apache-2.0
// The detectors' decoders, on tensors computed by hand.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/perception/segmentation/centernet.hpp"
#include "stillmap/perception/segmentation/detr.hpp"
#include "stillmap/perception/segmentation/nanodet.hpp"
#include "stillmap/perception/segmentation/ssd.hpp"
#include "tests/support/files.hpp"
#include "tests/support/tensors.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

void expect_box(const Candidate& candidate, const PixelBox& box) {
  EXPECT_NEAR(candidate.box.x0, box.x0, 1e-4);
  EXPECT_NEAR(candidate.box.y0, box.y0, 1e-4);
  EXPECT_NEAR(candidate.box.x1, box.x1, 1e-4);
  EXPECT_NEAR(candidate.box.y1, box.y1, 1e-4);
}

// Two resolutions of a 32x16 input: 4x2 cells of 8 pixels, 2x1 of 16; 2 classes, 3 bins.
struct NanoDetCase {
  Tensor fine_scores = zeros({1, 8, 2}), fine_boxes = zeros({1, 8, 12});
  Tensor coarse_scores = zeros({1, 2, 2}), coarse_boxes = zeros({1, 2, 12});

  [[nodiscard]] std::vector<Candidate> decode(float min_score) const {
    const std::vector<NanoDetLevel> levels = {{8, fine_scores.view(), fine_boxes.view()},
                                              {16, coarse_scores.view(), coarse_boxes.view()}};
    return decode_nanodet(levels, {32, 16}, min_score);
  }
};

TEST(NanoDet, DistancesAreMeansOfDistributions) {
  NanoDetCase nanodet;
  nanodet.fine_scores.values[5 * 2 + 1] = 0.75F;  // row 1, column 1: the point (12, 12)
  float* const logits = &nanodet.fine_boxes.values[5 * 12];
  logits[0] = 100;                                 // left: bin 0
  logits[3 + 1] = 100;                             // up: bin 1, one stride
  logits[6 + 2] = 100;                             // right: bin 2
  logits[9 + 1] = std::log(3.0F);                  // down: weights 1, 3, 1: bin 1
  nanodet.coarse_scores.values[1 * 2 + 0] = 0.5F;  // the point (24, 8), every bin alike: one stride
  const std::vector<Candidate> found = nanodet.decode(0.5F);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].label, 1);
  EXPECT_EQ(found[0].score, 0.75F);
  expect_box(found[0], {12, 4, 28, 20});
  EXPECT_EQ(found[1].label, 0);
  expect_box(found[1], {8, -8, 40, 24});
  EXPECT_THAT(nanodet.decode(0.8F), testing::IsEmpty());
}

TEST(NanoDet, RefusesOtherShapes) {
  NanoDetCase nanodet;
  nanodet.fine_scores = zeros({1, 7, 2});
  EXPECT_THAT(error_of([&] { (void)nanodet.decode(0.5F); }), HasSubstr("expected 8 cells"));
  nanodet = NanoDetCase();
  nanodet.coarse_boxes.values.pop_back();
  EXPECT_THAT(error_of([&] { (void)nanodet.decode(0.5F); }), HasSubstr("1x2x12 at stride 16"));
}

TEST(NanoDet, NanIsNoScore) {
  NanoDetCase nanodet;
  nanodet.fine_scores.values.assign(16, std::nanf(""));
  EXPECT_THAT(nanodet.decode(0.1F), testing::IsEmpty());
}

// A heat map of 4 rows, 6 columns, 2 classes over a 60x40 input: steps of 10 pixels.
TEST(CenterNet, PeaksWithTheirDistances) {
  Tensor heat = zeros({1, 4, 6, 2}), sizes = zeros({1, 4, 6, 4});
  const auto at = [&](int row, int column, int label) -> float& {
    return heat.values[static_cast<std::size_t>((row * 6 + column) * 2 + label)];
  };
  at(1, 2, 0) = 0.9F;
  at(1, 3, 0) = 0.8F;  // beside a higher one
  at(1, 3, 1) = 0.7F;  // of another class
  at(3, 5, 0) = 0.6F;  // in the corner
  at(0, 0, 0) = 0.2F;  // too low
  for (int i = 0; i < 4; ++i) {
    sizes.values[static_cast<std::size_t>((1 * 6 + 2) * 4 + i)] = static_cast<float>(i + 1);
  }
  const std::vector<Candidate> found = decode_centernet(heat.view(), sizes.view(), {60, 40}, 0.5F);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].score, 0.9F);
  expect_box(found[0], {19, 8, 23, 14});
  EXPECT_EQ(found[1].label, 1);
  EXPECT_EQ(found[2].score, 0.6F);
}

TEST(CenterNet, APlateauIsOnePeak) {
  Tensor heat = zeros({1, 3, 3, 1});
  heat.values.assign(9, 0.5F);
  const Tensor sizes = zeros({1, 3, 3, 4});
  EXPECT_EQ(decode_centernet(heat.view(), sizes.view(), {30, 30}, 0.5F).size(), 1U);
}

TEST(CenterNet, RefusesOtherShapes) {
  const Tensor heat = zeros({1, 3, 3, 2}), sizes = zeros({1, 3, 4, 4});
  EXPECT_THAT(error_of([&] {
                (void)decode_centernet(heat.view(), sizes.view(), {30, 30}, 0.5F);
              }),
              HasSubstr("1x3x3x2 and 1x3x4x4"));
}

// Two queries, two classes, an input of 200x100.
const Tensor kQueries{{1, 2, 4}, {0.5F, 0.5F, 0.2F, 0.4F, 0.1F, 0.1F, 0.1F, 0.1F}};

void expect_the_first_query(const std::vector<Candidate>& found) {
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].label, 1);
  EXPECT_NEAR(found[0].score, 0.75F, 1e-6);
  expect_box(found[0], {80, 30, 120, 70});
}

TEST(Detr, SharesBecomePixels) {
  const Tensor scores{{1, 2, 2}, {0.1F, 0.75F, 0.2F, 0.1F}};
  const NetworkExport two{ExportKind::kDetr, {1, 0}, {"a", "b"}, false};
  expect_the_first_query(decode_detr(detr_outputs(two, {scores, kQueries}), {200, 100}, 0.5F));
  const NetworkExport one{ExportKind::kDetr, {0}, {"a", "b"}, false};
  const Tensor both{{1, 2, 6},
                    {0.5F, 0.5F, 0.2F, 0.4F, 0.1F, 0.75F, 0.1F, 0.1F, 0.1F, 0.1F, 0.2F, 0.1F}};
  expect_the_first_query(decode_detr(detr_outputs(one, {both}), {200, 100}, 0.5F));
}

TEST(Detr, LogitsBecomeProbabilities) {
  const Tensor logits{{2, 2}, {-3, std::log(3.0F), -2, -5}};  // 3 / (1 + 3)
  const Tensor boxes{{2, 4}, kQueries.values};
  expect_the_first_query(decode_detr({boxes, logits}, {200, 100}, 0.5F));
}

TEST(Detr, RefusesWhatDoesNotFit) {
  const Tensor boxes{{2, 4}, kQueries.values};
  EXPECT_THAT(error_of([&] {
                (void)decode_detr({boxes, zeros({3, 2})}, {200, 100}, 0.5F);
              }),
              HasSubstr("2x4 and 3x2: expected 1xQx4 and 1xQxC"));
  Tensor pixels = boxes;
  pixels.values[0] = 100;
  EXPECT_THAT(error_of([&] {
                (void)decode_detr({pixels, zeros({2, 2})}, {200, 100}, 0.5F);
              }),
              HasSubstr("a side of a box at 100, expected shares of the image"));
}

struct SsdCase {
  // As shares of the input: one of a quarter of its area in the upper left, one in the middle.
  Tensor anchors{{2, 4}, {0, 0, 0.5F, 0.5F, 0.25F, 0.25F, 0.5F, 0.5F}};
  Tensor offsets = zeros({1, 2, 4});
  Tensor classes{{1, 2, 3}, {1, 0, 0, 0.2F, 0.1F, 0.7F}};

  [[nodiscard]] std::vector<Candidate> decode(float min_score) const {
    return decode_ssd({anchors.view(), offsets.view(), classes.view()}, {200, 100}, min_score);
  }
};

TEST(Ssd, WithoutOffsetsTheAnchorItself) {
  const std::vector<Candidate> found = SsdCase().decode(0.5F);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].label, 1);
  EXPECT_FLOAT_EQ(found[0].score, 0.7F);
  expect_box(found[0], {50, 25, 150, 75});
}

TEST(Ssd, OffsetsShiftAndScale) {
  SsdCase ssd;
  // A tenth of the anchor to the right for each 1, and e^(0.2 * 5 ln 2) = twice as high.
  ssd.offsets.values = {0, 0, 0, 0, 2, -1, 0, 5 * std::log(2.0F)};
  const std::vector<Candidate> found = ssd.decode(0.5F);
  ASSERT_EQ(found.size(), 1U);
  expect_box(found[0], {70, -5, 170, 95});
}

// The inverse of how the network is trained: offsets that encode a box decode to it.
TEST(Ssd, DecodesWhatTrainingEncodes) {
  SsdCase ssd;
  const double x0 = 0.1, y0 = 0.3, width = 0.45, height = 0.2;
  const double anchor_x = 0.25, anchor_y = 0.25, anchor_width = 0.5, anchor_height = 0.5;
  ssd.offsets.values = {
      0,
      0,
      0,
      0,
      static_cast<float>((x0 + width / 2 - anchor_x - anchor_width / 2) / anchor_width / 0.1),
      static_cast<float>((y0 + height / 2 - anchor_y - anchor_height / 2) / anchor_height / 0.1),
      static_cast<float>(std::log(width / anchor_width) / 0.2),
      static_cast<float>(std::log(height / anchor_height) / 0.2)};
  const std::vector<Candidate> found = ssd.decode(0.5F);
  ASSERT_EQ(found.size(), 1U);
  expect_box(found[0], {20, 30, 110, 50});
}

TEST(Ssd, LogitsBecomeProbabilities) {
  SsdCase ssd;
  ssd.classes.values = {9, 0, 0, 0, std::log(3.0F), 0};  // second anchor: 1/5, 3/5, 1/5
  const std::vector<Candidate> found = ssd.decode(0.5F);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].label, 0);
  EXPECT_NEAR(found[0].score, 0.6F, 1e-6);
}

TEST(Ssd, RefusesOtherShapes) {
  SsdCase ssd;
  ssd.offsets = zeros({1, 3, 4});
  EXPECT_THAT(error_of([&] { (void)ssd.decode(0.5F); }), HasSubstr("offsets 1x3x4"));
}

}  // namespace
}  // namespace stillmap
