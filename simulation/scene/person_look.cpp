// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/person_look.hpp"

#include <array>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {
namespace {

template <std::size_t N>
cv::Vec3b pick(const std::array<cv::Vec3b, N>& colors, HashStream& rng) {
  return colors[static_cast<std::size_t>(rng.below(static_cast<int>(N)))];
}

constexpr int kDark = 70;

}  // namespace

PersonLook random_look(std::uint64_t seed) {
  static const std::array<cv::Vec3b, 5> kSkins = {cv::Vec3b{236, 196, 172},
                                                  cv::Vec3b{222, 176, 146},
                                                  cv::Vec3b{198, 148, 116},
                                                  cv::Vec3b{150, 104, 76},
                                                  cv::Vec3b{104, 70, 52}};
  static const std::array<cv::Vec3b, 5> kHairs = {cv::Vec3b{36, 28, 24},
                                                  cv::Vec3b{70, 46, 32},
                                                  cv::Vec3b{118, 78, 46},
                                                  cv::Vec3b{176, 138, 84},
                                                  cv::Vec3b{120, 116, 112}};
  static const std::array<cv::Vec3b, 6> kShirts = {cv::Vec3b{176, 44, 46},
                                                   cv::Vec3b{36, 84, 150},
                                                   cv::Vec3b{44, 116, 76},
                                                   cv::Vec3b{206, 158, 52},
                                                   cv::Vec3b{96, 62, 124},
                                                   cv::Vec3b{60, 130, 150}};
  static const std::array<cv::Vec3b, 4> kTrousers = {
      cv::Vec3b{46, 62, 98}, cv::Vec3b{58, 58, 62}, cv::Vec3b{126, 110, 84}, cv::Vec3b{70, 82, 64}};
  HashStream rng(seed);
  PersonLook look;
  look.feminine = rng.below(2) == 0 ? rng.uniform(0.0, 0.15) : rng.uniform(0.8, 1.0);
  look.height_m = rng.uniform(1.70, 1.88) - 0.09 * look.feminine;
  look.girth = rng.uniform(0.93, 1.17);
  const bool long_hair = look.feminine > 0.5;
  look.hair = static_cast<HairStyle>(long_hair ? 2 + rng.below(3) : rng.below(2));
  look.shirt = static_cast<Fabric>(1 + rng.below(kFabrics - 1));
  look.long_sleeves = look.shirt == Fabric::kKnit || rng.below(2) == 0;
  look.tucked_in = rng.below(2) == 0;
  look.skin_color = pick(kSkins, rng);
  const cv::Vec3b hair = pick(kHairs, rng);
  // Dark skin is combined with dark hair that contrasts with it.
  look.hair_color = look.skin_color[0] < 160 ? kHairs[0] : hair;
  look.shirt_color = pick(kShirts, rng);
  const bool dark = look.shirt_color[0] + look.shirt_color[1] + look.shirt_color[2] < 3 * kDark;
  look.shirt_color_2 = dark || rng.below(3) != 0 ? cv::Vec3b{228, 226, 216} : cv::Vec3b{34, 34, 44};
  look.trousers_color = pick(kTrousers, rng);
  look.shoe_color = rng.below(2) == 0 ? cv::Vec3b{46, 32, 24} : cv::Vec3b{206, 206, 204};
  look.paint_seed = rng.bits();
  return look;
}

}  // namespace stillmap
