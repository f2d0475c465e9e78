// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace stillmap {

enum class HairStyle { kCrop, kShort, kBob, kLong, kBun };
inline constexpr int kHairStyles = 5;

enum class Fabric { kPlain, kStripes, kChecks, kKnit, kPrint };
inline constexpr int kFabrics = 5;

/// The looks of a person. Colours are red, green, blue.
struct PersonLook {
  double height_m = 1.75;
  double girth = 1.0;     ///< of the trunk, against slim: 0.92 to 1.2
  double feminine = 0.0;  ///< 0 to 1: narrower shoulders, wider hips
  HairStyle hair = HairStyle::kShort;
  Fabric shirt = Fabric::kStripes;
  bool long_sleeves = false;
  bool tucked_in = true;  ///< the belt shows
  cv::Vec3b skin_color{224, 178, 150};
  cv::Vec3b hair_color{60, 40, 30};
  cv::Vec3b shirt_color{40, 80, 150};
  cv::Vec3b shirt_color_2{230, 230, 225};
  cv::Vec3b trousers_color{50, 55, 75};
  cv::Vec3b shoe_color{40, 30, 25};
  std::uint64_t paint_seed = 1;
};

/// A random person; the same number gives the same person.
[[nodiscard]] PersonLook random_look(std::uint64_t seed);

}  // namespace stillmap
