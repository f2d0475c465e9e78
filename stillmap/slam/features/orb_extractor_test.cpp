// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/orb_extractor.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

DepthImage no_depth(const GrayImage& image) {
  return DepthImage(cv::Mat1f(image.mat.size(), 0.0F));
}

Features extract(const GrayImage& image, const OrbConfig& config = {}) {
  OrbExtractor extractor(config, camera_of_size(image.mat.cols, image.mat.rows));
  return extractor.extract(image, no_depth(image));
}

Features extract(const GrayImage& image, const cv::Mat1b& excluded) {
  const OrbExtractor extractor({}, camera_of_size(image.mat.cols, image.mat.rows));
  return extractor.extract(image, no_depth(image), Mask(excluded));
}

TEST(PyramidScales, ArePowersOfTheFactor) {
  const std::vector<float> scales = pyramid_scales({.levels = 4, .scale_factor = 1.5});
  EXPECT_EQ(scales, (std::vector<float>{1.0F, 1.5F, 2.25F, 3.375F}));
}

TEST(OrbExtractor, FindsAboutTheWantedNumberInsideTheImage) {
  const GrayImage image = textured_image(640, 480, 1);
  for (const int wanted : {200, 1000, 2000}) {
    const Features f = extract(image, {.features = wanted});
    EXPECT_GE(std::ssize(f.px), wanted * 95 / 100);
    EXPECT_LE(std::ssize(f.px), wanted + 4 * 8);  // 3 more a level, and rounding
    for (const auto& list : {f.raw_px, f.ideal_px, f.px}) ASSERT_EQ(list.size(), f.size());
    ASSERT_EQ(f.level.size(), f.size());
    ASSERT_EQ(f.angle_deg.size(), f.size());
    ASSERT_EQ(f.descriptors.size(), f.size());
    ASSERT_EQ(f.depth_m.size(), f.size());
    ASSERT_EQ(f.sensor_depth_m.size(), f.size());
    std::set<int> levels;
    for (std::size_t i = 0; i < f.size(); ++i) {
      EXPECT_TRUE(f.raw_px[i].x() >= 15 && f.raw_px[i].x() <= 625) << f.raw_px[i].transpose();
      EXPECT_TRUE(f.raw_px[i].y() >= 15 && f.raw_px[i].y() <= 465) << f.raw_px[i].transpose();
      EXPECT_TRUE(f.angle_deg[i] >= 0 && f.angle_deg[i] <= 360) << f.angle_deg[i];
      levels.insert(f.level[i]);
    }
    EXPECT_EQ(levels, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

TEST(OrbExtractor, SameImageGivesSameBits) {
  const GrayImage image = textured_image(320, 240, 2);
  const Features a = extract(image);
  OrbExtractor reused({}, camera_of_size(320, 240));
  (void)reused.extract(textured_image(320, 240, 3), no_depth(image));
  const Features b = reused.extract(image, no_depth(image));
  EXPECT_EQ(a.raw_px, b.raw_px);
  EXPECT_EQ(a.level, b.level);
  EXPECT_EQ(a.angle_deg, b.angle_deg);
  EXPECT_EQ(a.descriptors, b.descriptors);
}

TEST(OrbExtractor, CornersFoundAheadOfOtherImagesGiveTheSameBits) {
  const OrbExtractor extractor({}, camera_of_size(320, 240));
  std::vector<ImageCorners> ahead;
  for (std::uint32_t seed = 1; seed < 4; ++seed) {
    ahead.push_back(extractor.corners(textured_image(320, 240, seed)));
  }
  for (std::uint32_t seed = 1; seed < 4; ++seed) {
    const GrayImage image = textured_image(320, 240, seed);
    cv::Mat1b excluded(240, 320, std::uint8_t{0});
    excluded.colRange(50 * static_cast<int>(seed), 200).setTo(1);
    const Features a = extract(image, excluded);
    const Features b = extractor.extract(ahead[seed - 1], no_depth(image), Mask(excluded));
    EXPECT_GT(a.size(), 100U);
    EXPECT_EQ(a.raw_px, b.raw_px);
    EXPECT_EQ(a.descriptors, b.descriptors);
    const auto is_excluded = [&](const Eigen::Vector2f& px) {
      return excluded(cvRound(px.y()), cvRound(px.x())) != 0;
    };
    // A corner of a coarse level is rounded to another pixel of the finest.
    for (std::size_t i = 0; i < b.size(); ++i) {
      EXPECT_FALSE(b.level[i] == 0 && is_excluded(b.raw_px[i])) << b.raw_px[i].transpose();
    }
  }
}

TEST(OrbExtractor, DoesNotWriteToTheImage) {
  const GrayImage image = textured_image(320, 240, 4);
  const cv::Mat1b before = image.mat.clone();
  (void)extract(image);
  EXPECT_EQ(cv::norm(before, image.mat, cv::NORM_INF), 0.0);
}

TEST(OrbExtractor, FlatAndTinyImagesHaveNone) {
  EXPECT_EQ(extract(GrayImage(cv::Mat1b(480, 640, std::uint8_t{77}))).size(), 0U);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 300}, {300, 1}, {37, 37}, {50, 50}}) {
    EXPECT_EQ(extract(textured_image(width, height, 5)).size(), 0U) << width << "x" << height;
  }
  for (int size = 51; size < 90; ++size) {
    const Features f = extract(textured_image(size, size + 3, 6));
    EXPECT_LE(f.size(), 1032U);
  }
}

TEST(OrbExtractor, ImagesOfAnotherSizeAreRefused) {
  OrbExtractor extractor({}, camera_of_size(320, 240));
  const GrayImage image = textured_image(320, 200, 7);
  EXPECT_THROW((void)extractor.extract(image, no_depth(image)), InternalError);
  const GrayImage right = textured_image(320, 240, 7);
  EXPECT_THROW((void)extractor.extract(right, no_depth(image)), InternalError);
}

TEST(OrbExtractor, WeakCornersFillCellsWithoutStrongOnes) {
  // The left half with full contrast, the right half with a tenth of it.
  GrayImage image = textured_image(640, 480, 8);
  for (int y = 0; y < 480; ++y) {
    for (int x = 320; x < 640; ++x)
      image.mat(y, x) = static_cast<std::uint8_t>(115 + image.mat(y, x) / 10);
  }
  const auto on_the_right = [](const Features& f) {
    return std::ranges::count_if(f.raw_px, [](const auto& p) { return p.x() > 340; });
  };
  const auto weak = on_the_right(extract(image));
  EXPECT_GT(weak, 100);
  EXPECT_LT(on_the_right(extract(image, {.weak_corner_threshold = 20})), weak / 5);
}

TEST(OrbExtractor, ReadsTheDepthAtTheRawPixelAndZeroWhereItIsMissing) {
  const GrayImage image = textured_image(320, 240, 9);
  DepthImage depth = no_depth(image);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 160; ++x) depth.mat(y, x) = 1.0F + static_cast<float>(x + 320 * y) * 1e-4F;
  }
  CameraModel camera = builtin_camera("tum_fr1");
  camera.width_px = 320, camera.height_px = 240;
  const Features f = OrbExtractor({}, camera).extract(image, depth);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const auto x = static_cast<int>(std::lrint(f.raw_px[i].x()));
    const auto y = static_cast<int>(std::lrint(f.raw_px[i].y()));
    EXPECT_EQ(f.sensor_depth_m[i], depth.mat(y, x));
    missing += f.sensor_depth_m[i] == 0 ? 1U : 0U;
  }
  EXPECT_GT(missing, f.size() / 4);
  EXPECT_LT(missing, 3 * f.size() / 4);
  EXPECT_EQ(f.depth_m, f.sensor_depth_m);
}

TEST(OrbExtractor, UndistortsAndIndexesTheIdealPixels) {
  const GrayImage image = textured_image(640, 480, 10);
  const CameraModel camera = builtin_camera("tum_fr1");
  const Features f = OrbExtractor({}, camera).extract(image, no_depth(image));
  double farthest = 0;
  for (std::uint32_t i = 0; i < f.size(); ++i) {
    // distort() is the plain formula; core's tests compare it with OpenCV's.
    const Eigen::Vector2d back = camera.distort(f.ideal_px[i].cast<double>());
    EXPECT_LT((back - f.raw_px[i].cast<double>()).norm(), 1e-3);
    farthest = std::max<double>(farthest, (f.ideal_px[i] - f.raw_px[i]).norm());
    bool found = false;
    f.grid.visit_near(f.px[i], 0.5F, [&](std::uint32_t j) { found = found || j == i; });
    EXPECT_TRUE(found);
  }
  EXPECT_GT(farthest, 5.0);
  EXPECT_EQ(f.px, f.ideal_px);
}

TEST(OrbExtractor, HasNoFeaturesAtTheRimOfAVeryWideFisheye) {
  const GrayImage image = textured_image(640, 480, 10);
  CameraModel camera = builtin_camera("tum_fr3");
  camera.lens = LensModel::kFisheye;
  camera.fx = camera.fy = 210;  // 87 degrees from the axis at the sides
  const Features f = OrbExtractor({}, camera).extract(image, no_depth(image));
  double widest = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Eigen::Vector2d from_axis(f.raw_px[i].x() - camera.cx, f.raw_px[i].y() - camera.cy);
    const double angle = from_axis.norm() / 210;  // an equidistant lens without distortion
    widest = std::max(widest, angle);
    const Eigen::Vector2d slope = camera.unproject(f.ideal_px[i].cast<double>(), 1).head<2>();
    EXPECT_NEAR(slope.norm(), std::tan(angle), 1e-3);
  }
  EXPECT_GT(f.size(), 300U);
  EXPECT_LT(widest, 70.1 * 3.14159265 / 180);
  EXPECT_GT(widest, 65 * 3.14159265 / 180);
}

// The best match of a feature among those of another image near where the image's motion puts it.
std::optional<std::uint32_t> match_at(const Features& f,
                                      const Descriptor& descriptor,
                                      const Eigen::Vector2f& at,
                                      float radius) {
  Projection p{at, radius, 0, 1, 0, 7, &descriptor};
  const auto matches = match_projections({&p, 1}, f, {}, {.max_distance = 40});
  if (matches.empty()) return std::nullopt;
  return matches[0].feature;
}

TEST(OrbExtractor, FeaturesTurnWithTheImage) {
  const GrayImage image = textured_image(480, 480, 11);
  cv::Mat1b turned;
  cv::rotate(image.mat, turned, cv::ROTATE_90_CLOCKWISE);
  const Features f = extract(image), g = extract(GrayImage(turned));
  std::size_t matched = 0, aligned = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Eigen::Vector2f at(479 - f.raw_px[i].y(), f.raw_px[i].x());  // clockwise, y down
    const auto j = match_at(g, f.descriptors[i], at, 2.0F);
    if (!j) continue;
    ++matched;
    const float turn = g.angle_deg[*j] - f.angle_deg[i] - 90.0F;
    aligned += std::abs(std::remainder(turn, 360.0F)) < 3.0F ? 1U : 0U;
  }
  EXPECT_GT(matched, f.size() * 8 / 10);
  EXPECT_GT(aligned, matched * 95 / 100);
}

TEST(OrbExtractor, FeaturesOfAShrunkImageAreFoundOnFinerLevels) {
  const GrayImage image = textured_image(640, 480, 12);
  cv::Mat1b half;  // 1.44 = two levels
  cv::resize(image.mat, half, cv::Size(444, 333), 0, 0, cv::INTER_AREA);
  const Features f = extract(image), g = extract(GrayImage(half));
  std::size_t coarse = 0, matched = 0;
  double levels = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (f.level[i] < 2) continue;
    ++coarse;
    const float ratio = 444.0F / 640.0F;
    const Eigen::Vector2f at = (f.raw_px[i].array() + 0.5F) * ratio - 0.5F;
    const auto j = match_at(g, f.descriptors[i], at, 3.0F);
    if (!j) continue;
    ++matched;
    levels += f.level[i] - g.level[*j];
  }
  EXPECT_GT(matched, coarse * 6 / 10);
  EXPECT_NEAR(levels / static_cast<double>(matched), 2.0, 0.3);
}

// A level's pixel covers several of the image's, and its centre is theirs. The corners of a square
// are found somewhat inside of it, alike on all sides, so that their mean is the square's centre.
TEST(OrbExtractor, PositionsOfAllLevelsAreThoseOfTheFullImage) {
  TestDice dice(13);
  std::array<Eigen::Vector2d, 8> offset{};
  std::array<int, 8> count{};
  offset.fill(Eigen::Vector2d::Zero());
  for (int round = 0; round < 40; ++round) {
    cv::Mat1b image(480, 640, std::uint8_t{40});
    const int x = dice.integer(150, 400), y = dice.integer(120, 270), size = dice.integer(60, 90);
    image(cv::Rect(x, y, size, size)) = 220;
    cv::GaussianBlur(image, image, cv::Size(5, 5), 1.0);  // no two pixels tie as corners
    const Eigen::Vector2d center(x + 0.5 * (size - 1), y + 0.5 * (size - 1));
    const Features f = extract(GrayImage(image), {.features = 400});
    for (std::uint8_t level = 0; level < 8; ++level) {
      // Corners may be doubled: first the mean of each of the four, then of these.
      std::array<Eigen::Vector2d, 4> sum{};
      std::array<int, 4> seen{};
      sum.fill(Eigen::Vector2d::Zero());
      for (std::size_t i = 0; i < f.size(); ++i) {
        if (f.level[i] != level) continue;
        const Eigen::Vector2d p = f.raw_px[i].cast<double>() - center;
        const std::size_t quarter = (p.x() < 0 ? 0U : 1U) + (p.y() < 0 ? 0U : 2U);
        sum[quarter] += p;
        ++seen[quarter];
      }
      if (std::ranges::count(seen, 0) > 0) continue;
      for (std::size_t q = 0; q < 4; ++q) offset[level] += 0.25 * sum[q] / seen[q];
      ++count[level];
    }
  }
  const std::vector<float> scales = pyramid_scales({});
  for (std::size_t level = 0; level < 8; ++level) {
    ASSERT_GE(count[level], 20) << level;
    const Eigen::Vector2d mean = offset[level] / count[level];
    EXPECT_LT(mean.norm(), 0.15 * static_cast<double>(scales[level]))
        << level << ": " << mean.transpose();
  }
}

}  // namespace
}  // namespace stillmap
