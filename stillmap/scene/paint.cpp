// SPDX-License-Identifier: Apache-2.0
#include "stillmap/scene/paint.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/scene/hash_random.hpp"

namespace stillmap {
namespace {

using Color = cv::Vec3b;

cv::Scalar scalar(const Color& c) {
  return {double(c[0]), double(c[1]), double(c[2])};
}

Color random_color(HashStream& rng, int low, int high) {
  Color c;
  const int brightness = low + rng.below(high - low);
  for (int i = 0; i < 3; ++i) {
    c[i] = cv::saturate_cast<std::uint8_t>(brightness + rng.below(81) - 40);
  }
  return c;
}

// A colour that stands out from `other`.
Color contrasting_color(HashStream& rng, const Color& other) {
  const int brightness = (other[0] + other[1] + other[2]) / 3;
  return brightness > 127 ? random_color(rng, 10, 80) : random_color(rng, 170, 245);
}

// A canvas with the scale that turns metres into texels.
struct Canvas {
  cv::Mat3b picture;
  double texel_m;

  [[nodiscard]] int texels(double metres) const {
    return std::max(1, static_cast<int>(std::lround(metres / texel_m)));
  }
  [[nodiscard]] cv::Rect bounds() const { return {0, 0, picture.cols, picture.rows}; }
};

void fill(Canvas& canvas, const cv::Rect& rect, const Color& color) {
  const cv::Rect inside = rect & canvas.bounds();
  if (!inside.empty()) canvas.picture(inside).setTo(scalar(color));
}

// One octave of value noise: random values on a lattice with `cell_m` spacing, interpolated.
cv::Mat1b value_noise(const Canvas& canvas, cv::Size2d cell_m, std::uint64_t seed) {
  const cv::Size lattice(canvas.picture.cols / canvas.texels(cell_m.width) + 2,
                         canvas.picture.rows / canvas.texels(cell_m.height) + 2);
  HashStream rng(seed);
  cv::Mat1b values(lattice);
  for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(rng.bits() >> 56U);
  cv::Mat1b noise;
  cv::resize(values, noise, canvas.picture.size(), 0, 0, cv::INTER_LINEAR);
  return noise;
}

// Adds noise of several octaves, each half as coarse as the one before, of `contrast` grey values.
void add_noise(Canvas& canvas, cv::Size2d cell_m, double contrast, HashStream& rng) {
  cv::Mat1s sum = cv::Mat1s::zeros(canvas.picture.size());
  double share = 0.5;
  while (cell_m.width > 2.0 * canvas.texel_m && share > 0.05) {
    const cv::Mat1b noise = value_noise(canvas, cell_m, rng.bits());
    cv::Mat1s scaled;
    noise.convertTo(scaled, CV_16S, contrast * share / 127.5, -contrast * share);
    sum += scaled;
    cell_m = cell_m * 0.5;
    share *= 0.7;
  }
  for (int y = 0; y < sum.rows; ++y) {
    for (int x = 0; x < sum.cols; ++x) {
      Color& c = canvas.picture(y, x);
      for (int i = 0; i < 3; ++i) c[i] = cv::saturate_cast<std::uint8_t>(c[i] + sum(y, x));
    }
  }
}

// A rectangle somewhere inside `area`, with sides log-uniform between min_m and max_m.
cv::Rect random_rect(const Canvas& canvas,
                     const cv::Rect& area,
                     cv::Vec2d range_m,
                     HashStream& rng) {
  const auto side = [&] {
    return canvas.texels(range_m[0] * std::pow(range_m[1] / range_m[0], rng.uniform(0, 1)));
  };
  const int width = std::min(side(), area.width), height = std::min(side(), area.height);
  return {area.x + rng.below(area.width - width + 1),
          area.y + rng.below(area.height - height + 1),
          width,
          height};
}

void scatter_rects(
    Canvas& canvas, const cv::Rect& area, int count, cv::Vec2d range_m, HashStream& rng) {
  for (int i = 0; i < count; ++i) {
    fill(canvas, random_rect(canvas, area, range_m, rng), random_color(rng, 15, 240));
  }
}

void checker(Canvas& canvas, const cv::Rect& area, double cell_m, HashStream& rng) {
  const Color a = random_color(rng, 10, 245);
  const Color b = contrasting_color(rng, a);
  const int cell = canvas.texels(cell_m);
  for (int y = 0; y * cell < area.height; ++y) {
    for (int x = 0; x * cell < area.width; ++x) {
      const cv::Rect field(area.x + x * cell, area.y + y * cell, cell, cell);
      fill(canvas, field & area, (x + y) % 2 == 0 ? a : b);
    }
  }
}

// A row of characters of an alphabet nobody reads: 3 x 5 cells each, random.
void glyph_row(Canvas& canvas, const cv::Rect& row, const Color& ink, HashStream& rng) {
  const int cell = std::max(1, row.height / 5);
  for (int x = row.x; x + 3 * cell <= row.x + row.width; x += 4 * cell) {
    const std::uint64_t pattern = rng.bits() | (rng.bits() & 0x1249U);
    if (rng.below(7) == 0) continue;  // a space between words
    for (unsigned bit = 0; bit < 15; ++bit) {
      if (((pattern >> bit) & 1U) == 0) continue;
      const int column = static_cast<int>(bit % 3), line = static_cast<int>(bit / 3);
      const cv::Rect square(x + column * cell, row.y + line * cell, cell, cell);
      fill(canvas, square & row, ink);
    }
  }
}

void text_block(Canvas& canvas, const cv::Rect& area, double height_m, HashStream& rng) {
  const Color paper = random_color(rng, 30, 230);
  const Color ink = contrasting_color(rng, paper);
  fill(canvas, area, paper);
  const int height = 5 * canvas.texels(height_m / 5.0);
  const int margin = height / 2;
  for (int y = area.y + margin; y + height <= area.y + area.height; y += height + height / 2) {
    const int length = area.width - 2 * margin - rng.below(area.width / 3 + 1);
    glyph_row(canvas, {area.x + margin, y, std::max(length, 0), height}, ink, rng);
  }
}

// Shapes, checkers and text over an area, the way cartons, covers and posters are printed.
void print_page(Canvas& canvas, const cv::Rect& area, HashStream& rng) {
  const double size_m = std::min(area.width, area.height) * canvas.texel_m;
  fill(canvas, area, random_color(rng, 40, 220));
  scatter_rects(canvas, area, 14, {0.08 * size_m, 0.5 * size_m}, rng);
  for (int i = 0; i < 3; ++i) {
    const cv::Rect block = random_rect(canvas, area, {0.25 * size_m, 0.6 * size_m}, rng);
    if (rng.below(3) == 0) {
      checker(canvas, block, rng.uniform(0.02, 0.06), rng);
    } else {
      text_block(canvas, block, rng.uniform(0.03, 0.1), rng);
    }
  }
  scatter_rects(canvas, area, 20, {0.015, 0.12 * size_m}, rng);
}

void paint_wall(Canvas& canvas, int posters, HashStream& rng) {
  fill(canvas, canvas.bounds(), random_color(rng, 150, 190));
  add_noise(canvas, {0.8, 0.8}, 18.0, rng);
  // The blank stretch: a sixth of the wall keeps its plaster alone.
  const int blank_from = rng.below(5), strip = canvas.picture.cols / 6;
  for (int i = 0; i < posters; ++i) {
    const cv::Rect poster = random_rect(canvas, canvas.bounds(), {0.3, 1.0}, rng);
    const cv::Rect blank(blank_from * strip, 0, strip, canvas.picture.rows);
    if (!(poster & blank).empty()) continue;
    print_page(canvas, poster, rng);
  }
}

void paint_floor(Canvas& canvas, HashStream& rng) {
  fill(canvas, canvas.bounds(), random_color(rng, 90, 110));
  const int tile = canvas.texels(0.5);
  for (int y = 0; y < canvas.picture.rows; y += tile) {
    for (int x = 0; x < canvas.picture.cols; x += tile) {
      fill(canvas, {x, y, tile, tile}, random_color(rng, 70, 150));
    }
  }
  const double area_m2 = canvas.picture.total() * canvas.texel_m * canvas.texel_m;
  scatter_rects(canvas, canvas.bounds(), static_cast<int>(25 * area_m2), {0.02, 0.12}, rng);
  add_noise(canvas, {0.3, 0.3}, 50.0, rng);
}

void paint_ceiling(Canvas& canvas, HashStream& rng) {
  fill(canvas, canvas.bounds(), random_color(rng, 180, 200));
  const int panel = canvas.texels(0.6);
  for (int y = 0; y < canvas.picture.rows; y += panel) {
    for (int x = 0; x < canvas.picture.cols; x += panel) {
      fill(canvas, {x, y, panel - 2, panel - 2}, random_color(rng, 150, 230));
    }
  }
  scatter_rects(canvas, canvas.bounds(), 200, {0.03, 0.15}, rng);
}

void paint_wood(Canvas& canvas, HashStream& rng) {
  fill(canvas, canvas.bounds(), Color(150, 115, 80));
  add_noise(canvas, {0.4, 0.03}, 60.0, rng);
  const double area_m2 = canvas.picture.total() * canvas.texel_m * canvas.texel_m;
  for (int i = 0; i < static_cast<int>(6 * area_m2) + 1; ++i) {
    const cv::Rect paper = random_rect(canvas, canvas.bounds(), {0.15, 0.3}, rng);
    text_block(canvas, paper, rng.uniform(0.02, 0.05), rng);
  }
  scatter_rects(canvas, canvas.bounds(), static_cast<int>(60 * area_m2), {0.01, 0.06}, rng);
}

void paint_spines(Canvas& canvas, HashStream& rng) {
  for (int x = 0; x < canvas.picture.cols;) {
    const int width = canvas.texels(rng.uniform(0.025, 0.06));
    const Color cover = random_color(rng, 30, 225);
    fill(canvas, {x, 0, width, canvas.picture.rows}, cover);
    for (int label = 0; label < 3; ++label) {
      const cv::Rect place(x + width / 6, rng.below(canvas.picture.rows), 2 * width / 3, width);
      fill(canvas, place, contrasting_color(rng, cover));
    }
    x += width;
  }
}

}  // namespace

cv::Mat3b paint(Paint kind, double width_m, double height_m, double texel_m, std::uint64_t seed) {
  STILLMAP_CHECK(width_m > 0 && height_m > 0 && texel_m > 0);
  const int cols = std::max(1, static_cast<int>(std::lround(width_m / texel_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(height_m / texel_m)));
  Canvas canvas{cv::Mat3b(rows, cols), texel_m};
  HashStream rng(seed);
  switch (kind) {
    case Paint::kWall:
      paint_wall(canvas, 40, rng);
      break;
    case Paint::kBareWall:
      paint_wall(canvas, 30, rng);
      break;
    case Paint::kFloor:
      paint_floor(canvas, rng);
      break;
    case Paint::kCeiling:
      paint_ceiling(canvas, rng);
      break;
    case Paint::kWood:
      paint_wood(canvas, rng);
      break;
    case Paint::kPrinted:
      print_page(canvas, canvas.bounds(), rng);
      break;
    case Paint::kSpines:
      paint_spines(canvas, rng);
      break;
  }
  return canvas.picture;
}

}  // namespace stillmap
