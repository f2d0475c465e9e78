// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/brief.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "stillmap/slam/features/brief_pattern.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// Moments straight from the definition, over all pixels at most 15 away.
double orientation_directly(const cv::Mat1b& image, cv::Point at) {
  double m10 = 0, m01 = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int dx = x - at.x, dy = y - at.y;
      if (dx * dx + dy * dy > 15 * 15) continue;
      m10 += dx * image(y, x);
      m01 += dy * image(y, x);
    }
  }
  const double degrees = std::atan2(m01, m10) / kRadiansPerDegree;
  return degrees < 0 ? degrees + 360.0 : degrees;
}

double turn_between(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0));
}

TEST(PatchOrientation, EqualsTheMomentsWithinTheArctangentsError) {
  const GrayImage image = textured_image(200, 150, 1);
  TestDice dice(2);
  for (int i = 0; i < 300; ++i) {
    const cv::Point at(dice.integer(15, 184), dice.integer(15, 134));
    const float angle = patch_orientation_deg(image.mat, at);
    EXPECT_GE(angle, 0.0F);
    EXPECT_LE(angle, 360.0F);
    // cv::fastAtan2 promises 0.3 degrees.
    EXPECT_LT(turn_between(angle, orientation_directly(image.mat, at)), 0.3) << at;
  }
}

TEST(PatchOrientation, PointsFromDarkToBright) {
  cv::Mat1b right(31, 31, std::uint8_t{0}), down(31, 31, std::uint8_t{0});
  right.colRange(16, 31) = 200;
  down.rowRange(16, 31) = 200;
  EXPECT_NEAR(patch_orientation_deg(right, {15, 15}), 0.0F, 0.3F);
  EXPECT_NEAR(patch_orientation_deg(down, {15, 15}), 90.0F, 0.3F);  // y is down
}

// One test of the pattern, at an angle, in double precision. False when a coordinate is too near to
// half a pixel for the rounding to be beyond doubt.
struct SlowTest {
  bool certain = true;
  bool darker = false;
};

SlowTest brief_directly(const cv::Mat1b& image,
                        cv::Point at,
                        double angle_deg,
                        const BriefTest& t) {
  const double c = std::cos(angle_deg * kRadiansPerDegree);
  const double s = std::sin(angle_deg * kRadiansPerDegree);
  SlowTest result;
  const auto value = [&](int x, int y) {
    const double u = c * x - s * y, v = s * x + c * y;  // turned by the angle
    for (const double w : {u, v}) {
      if (std::abs(w - std::floor(w) - 0.5) < 1e-4) result.certain = false;
    }
    return image(at.y + static_cast<int>(std::lround(v)), at.x + static_cast<int>(std::lround(u)));
  };
  result.darker = value(t.x0, t.y0) < value(t.x1, t.y1);
  return result;
}

TEST(RotatedBrief, EqualsTheSlowVersion) {
  const GrayImage image = textured_image(200, 150, 3);
  TestDice dice(4);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const cv::Point at(dice.integer(17, 182), dice.integer(17, 132));
    const float angle = dice.uniform(0, 360);
    const Descriptor descriptor = rotated_brief(image.mat, at, angle);
    for (std::size_t bit = 0; bit < 256; ++bit) {
      const SlowTest slow =
          brief_directly(image.mat, at, static_cast<double>(angle), kBriefPattern[bit]);
      if (!slow.certain) continue;
      ++compared;
      const bool set = ((descriptor[bit / 64] >> (bit % 64)) & 1U) != 0;
      EXPECT_EQ(set, slow.darker) << "bit " << bit << " at " << angle;
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST(RotatedBrief, UnturnedReadsThePatternItself) {
  const GrayImage image = textured_image(60, 60, 5);
  const Descriptor descriptor = rotated_brief(image.mat, {30, 30}, 0);
  for (std::size_t bit = 0; bit < 256; ++bit) {
    const BriefTest& t = kBriefPattern[bit];
    const bool darker = image.mat(30 + t.y0, 30 + t.x0) < image.mat(30 + t.y1, 30 + t.x1);
    EXPECT_EQ(((descriptor[bit / 64] >> (bit % 64)) & 1U) != 0, darker) << bit;
  }
}

TEST(BriefPattern, StaysInThePatchAndRepeatsNothing) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < kBriefPattern.size(); ++i) {
    const BriefTest& t = kBriefPattern[i];
    EXPECT_LE(t.x0 * t.x0 + t.y0 * t.y0, kPatchRadiusPx * kPatchRadiusPx) << i;
    EXPECT_LE(t.x1 * t.x1 + t.y1 * t.y1, kPatchRadiusPx * kPatchRadiusPx) << i;
    EXPECT_FALSE(t.x0 == t.x1 && t.y0 == t.y1) << i;
    for (std::size_t j = 0; j < i; ++j) {
      const BriefTest& u = kBriefPattern[j];
      if (t.x0 == u.x0 && t.y0 == u.y0 && t.x1 == u.x1 && t.y1 == u.y1) ++equal;
      if (t.x0 == u.x1 && t.y0 == u.y1 && t.x1 == u.x0 && t.y1 == u.y0) ++equal;
    }
  }
  EXPECT_EQ(equal, 0U);
}

}  // namespace
}  // namespace stillmap
