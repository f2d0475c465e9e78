// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// What a procedural picture shows.
enum class Paint {
  kWall,      ///< plaster with posters, and a blank stretch
  kBareWall,  ///< plaster with few posters
  kFloor,     ///< carpet tiles
  kCeiling,   ///< panels
  kWood,      ///< grain, scratches, stains, papers lying about
  kPrinted,   ///< a carton or a book cover: shapes, checkers, rows of glyphs
  kSpines,    ///< a row of books, seen from the front
};

/// Paints a picture of width_m x height_m metres with `texel_m` metres a texel: corners at several
/// scales. The same arguments give the same picture.
[[nodiscard]] cv::Mat3b paint(
    Paint kind, double width_m, double height_m, double texel_m, std::uint64_t seed);

}  // namespace stillmap
