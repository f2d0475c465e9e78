// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/person_paint.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {
namespace {

constexpr double kTexel_m = 0.00125;
constexpr int kTile_px = 200;

cv::Scalar scalar(const cv::Vec3b& color) {
  return {double(color[0]), double(color[1]), double(color[2])};
}

cv::Vec3b mix(const cv::Vec3b& a, const cv::Vec3b& b, double share_b) {
  cv::Vec3b mixed;
  for (int i = 0; i < 3; ++i) {
    mixed[i] = cv::saturate_cast<std::uint8_t>((1.0 - share_b) * a[i] + share_b * b[i]);
  }
  return mixed;
}

cv::Vec3b shade(const cv::Vec3b& color, double by) {
  return by < 0 ? mix(color, {0, 0, 0}, -by) : mix(color, {255, 255, 255}, by);
}

// Grain of `grain` pixels and +- `contrast` grey values.
void add_grain(cv::Mat3b& picture, cv::Size grain, double contrast, std::uint64_t seed) {
  cv::Mat1b coarse((picture.rows + grain.height - 1) / grain.height,
                   (picture.cols + grain.width - 1) / grain.width);
  HashStream rng(seed);
  for (std::uint8_t& value : coarse) value = static_cast<std::uint8_t>(rng.bits() >> 56U);
  cv::Mat1b noise;
  cv::resize(coarse, noise, picture.size(), 0, 0, cv::INTER_LINEAR);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double by = (noise(y, x) - 127.5) / 127.5 * contrast;
      for (int i = 0; i < 3; ++i) {
        picture(y, x)[i] = cv::saturate_cast<std::uint8_t>(picture(y, x)[i] + by);
      }
    }
  }
}

// The colour of a shirt at (x, y) in texels; all patterns repeat after kTile_px.
cv::Vec3b cloth_color(const PersonLook& look, int x, int y) {
  const cv::Vec3b& a = look.shirt_color;
  const cv::Vec3b& b = look.shirt_color_2;
  switch (look.shirt) {
    case Fabric::kStripes:
      return (y % 40) < 16 ? b : a;
    case Fabric::kChecks: {
      const bool wide = (x % 50) < 22;
      const bool high = (y % 50) < 22;
      if ((x % 50) == 36 || (y % 50) == 36) return b;
      return wide && high ? shade(a, -0.45) : wide || high ? mix(a, b, 0.30) : mix(a, b, 0.75);
    }
    case Fabric::kKnit: {
      const int row = y / 10;
      const int slant = std::abs(x % 20 - 10) / 2;
      const bool groove = (y + slant) % 10 < 3;
      const bool band = row % 10 == 2 || row % 10 == 5;
      return shade(band ? b : a, groove ? -0.35 : 0.05);
    }
    case Fabric::kPrint:
    case Fabric::kPlain:
      break;
  }
  return a;
}

cv::Mat3b cloth(const PersonLook& look, cv::Size size) {
  cv::Mat3b picture(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) picture(y, x) = cloth_color(look, x, y);
  }
  add_grain(picture, {2, 2}, 9.0, look.paint_seed);
  add_grain(picture, {25, 25}, 8.0, look.paint_seed + 1);
  return picture;
}

// Big letters and a badge.
void print_on(cv::Mat3b& picture, const cv::Rect& area, const PersonLook& look) {
  HashStream rng(look.paint_seed + 2);
  const cv::Vec3b ink = look.shirt_color_2;
  const cv::Vec3b second = shade(mix(ink, look.shirt_color, 0.45), 0.15);
  const cv::Point middle(area.x + area.width / 2, area.y + area.height / 2);
  const int unit = area.height / 8;
  cv::circle(picture, middle, 3 * unit, scalar(second), cv::FILLED, cv::LINE_AA);
  cv::circle(picture, middle, 3 * unit, scalar(ink), unit / 4, cv::LINE_AA);
  for (int ray = 0; ray < 9; ++ray) {
    const double angle = 2.0 * CV_PI * (ray + rng.uniform(0.0, 0.4)) / 9.0;
    const cv::Point out(static_cast<int>(middle.x + 2.8 * unit * std::cos(angle)),
                        static_cast<int>(middle.y + 2.8 * unit * std::sin(angle)));
    cv::line(
        picture, middle, out, scalar(ray % 2 == 0 ? ink : look.shirt_color), unit / 3, cv::LINE_AA);
  }
  std::string word;
  for (int i = 0; i < 5; ++i) word += static_cast<char>('A' + rng.below(26));
  const int font = cv::FONT_HERSHEY_DUPLEX;
  int baseline = 0;
  const double size = 0.036 * unit * 2.0;
  const cv::Size box = cv::getTextSize(word, font, size, 4, &baseline);
  cv::putText(picture,
              word,
              {middle.x - box.width / 2, area.y + area.height + unit / 2},
              font,
              size,
              scalar(ink),
              4,
              cv::LINE_AA);
}

cv::Point face_point(double right_of_middle_m, double below_top_m) {
  return {
      static_cast<int>(std::lround((0.5 * double(kFaceWidth_m) + right_of_middle_m) / kTexel_m)),
      static_cast<int>(std::lround(below_top_m / kTexel_m))};
}

cv::Size face_size(double width_m, double height_m) {
  return {static_cast<int>(std::lround(width_m / kTexel_m)),
          static_cast<int>(std::lround(height_m / kTexel_m))};
}

void fill_ellipse(cv::Mat3b& picture, cv::Point center, cv::Size half, const cv::Vec3b& color) {
  cv::ellipse(picture, center, half, 0, 0, 360, scalar(color), cv::FILLED, cv::LINE_AA);
}

// Cheeks, eye sockets, the sides of the nose: soft.
void paint_shadows(cv::Mat3b& picture, const PersonLook& look) {
  const cv::Vec3b rosy = mix(look.skin_color, {214, 92, 84}, 0.32);
  const cv::Vec3b dark = shade(look.skin_color, -0.28);
  for (const double side : {-1.0, 1.0}) {
    fill_ellipse(picture, face_point(side * 0.040, 0.150), face_size(0.018, 0.014), rosy);
    fill_ellipse(picture, face_point(side * 0.032, 0.108), face_size(0.021, 0.012), dark);
    fill_ellipse(picture, face_point(side * 0.015, 0.135), face_size(0.004, 0.020), dark);
  }
  fill_ellipse(picture, face_point(0, 0.156), face_size(0.017, 0.006), dark);
  fill_ellipse(picture, face_point(0, 0.198), face_size(0.016, 0.004), dark);
  if (look.feminine < 0.5) {  // stubble
    fill_ellipse(picture,
                 face_point(0, 0.196),
                 face_size(0.050, 0.030),
                 mix(look.skin_color, look.hair_color, 0.22));
  }
  cv::GaussianBlur(picture, picture, {0, 0}, 4.0);
}

void paint_eye(cv::Mat3b& picture, double side, const PersonLook& look) {
  const cv::Point eye = face_point(side * 0.032, 0.110);
  fill_ellipse(picture, eye, face_size(0.0155, 0.0080), {246, 244, 240});
  const bool light = look.hair_color[0] > 110;
  fill_ellipse(picture,
               eye,
               face_size(0.0068, 0.0074),
               light ? cv::Vec3b{76, 110, 140} : cv::Vec3b{70, 46, 30});
  fill_ellipse(picture, eye, face_size(0.0032, 0.0036), {12, 10, 10});
  fill_ellipse(picture, eye + cv::Point(2, -2), {1, 1}, {255, 255, 255});
  cv::ellipse(
      picture, eye, face_size(0.0165, 0.0090), 0, 190, 350, scalar({36, 26, 24}), 2, cv::LINE_AA);
  const cv::Vec3b brow = shade(mix(look.hair_color, {0, 0, 0}, 0.2), 0);
  cv::ellipse(picture,
              face_point(side * 0.033, 0.097),
              face_size(0.022, 0.010),
              side * 4,
              205,
              335,
              scalar(brow),
              look.feminine < 0.5 ? 5 : 3,
              cv::LINE_AA);
}

}  // namespace

cv::Mat3b paint_cloth(const PersonLook& look) {
  return cloth(look, {kTile_px, kTile_px});
}

cv::Mat3b paint_trunk(const PersonLook& look) {
  const int width = static_cast<int>(std::lround(double(kTrunkGirth_m) / kTexel_m));
  const int height = static_cast<int>(std::lround(double(kTrunkTop_m - kTrunkBottom_m) / kTexel_m));
  cv::Mat3b picture = cloth(look, {width, height});
  const auto row = [&](double z) { return static_cast<int>((double(kTrunkTop_m) - z) / kTexel_m); };
  if (look.shirt == Fabric::kPrint || look.shirt == Fabric::kPlain) {
    const int side = static_cast<int>(0.22 / kTexel_m);
    print_on(picture, {width / 2 - side / 2, row(0.40), side, side}, look);
    print_on(picture, {5, row(0.40), side, side}, look);
  } else {  // a row of buttons
    cv::line(
        picture, {width / 2, 0}, {width / 2, height}, scalar(shade(look.shirt_color, -0.4)), 2);
    for (int y = row(0.42); y < height; y += 64) {
      cv::circle(picture, {width / 2 + 8, y}, 5, scalar({240, 236, 226}), cv::FILLED, cv::LINE_AA);
    }
  }
  return picture;
}

cv::Mat3b paint_trousers(const PersonLook& look) {
  cv::Mat3b picture(kTile_px, kTile_px, look.trousers_color);
  for (int y = 0; y < kTile_px; ++y) {
    for (int x = 0; x < kTile_px; ++x) {
      if ((x + y) % 5 == 0) picture(y, x) = shade(look.trousers_color, 0.14);
    }
  }
  add_grain(picture, {2, 5}, 16.0, look.paint_seed + 3);
  add_grain(picture, {20, 40}, 14.0, look.paint_seed + 4);
  cv::line(picture, {30, 0}, {30, kTile_px}, scalar(shade(look.trousers_color, -0.4)), 3);
  for (int y = 0; y < kTile_px; y += 10) {
    cv::line(picture, {35, y}, {35, y + 5}, scalar(shade(look.trousers_color, 0.35)), 1);
  }
  return picture;
}

cv::Mat3b paint_hair(const PersonLook& look) {
  cv::Mat3b picture(kTile_px, kTile_px, look.hair_color);
  add_grain(picture, {3, 60}, 26.0, look.paint_seed + 5);
  add_grain(picture, {9, 90}, 18.0, look.paint_seed + 6);
  return picture;
}

cv::Mat3b paint_skin(const PersonLook& look) {
  cv::Mat3b picture(kTile_px, kTile_px, look.skin_color);
  add_grain(picture, {12, 12}, 7.0, look.paint_seed + 7);
  add_grain(picture, {50, 50}, 8.0, look.paint_seed + 8);
  return picture;
}

cv::Mat3b paint_face(const PersonLook& look) {
  cv::Mat3b picture(face_size(double(kFaceWidth_m), double(kFaceHeight_m)), look.skin_color);
  paint_shadows(picture, look);
  for (const double side : {-1.0, 1.0}) {
    paint_eye(picture, side, look);
    fill_ellipse(picture,
                 face_point(side * 0.008, 0.1555),
                 face_size(0.004, 0.002),
                 shade(look.skin_color, -0.6));
  }
  const cv::Vec3b lips = mix(look.skin_color, {168, 52, 56}, 0.45 + 0.35 * look.feminine);
  fill_ellipse(picture, face_point(0, 0.181), face_size(0.024, 0.0065), lips);
  cv::ellipse(picture,
              face_point(0, 0.176),
              face_size(0.024, 0.006),
              0,
              15,
              165,
              scalar(shade(lips, -0.55)),
              1,
              cv::LINE_AA);
  add_grain(picture, {3, 3}, 4.0, look.paint_seed + 9);
  return picture;
}

}  // namespace stillmap
