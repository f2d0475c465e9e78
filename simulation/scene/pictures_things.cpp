// SPDX-License-Identifier: Apache-2.0
// Pictures of pictures.hpp: wood, cloth, and things on desks.
#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/scene/canvas.hpp"
#include "simulation/scene/pictures.hpp"

namespace stillmap {
namespace {

// A window of a desktop: a bar with a title, below it lines of code, or text beside a picture.
void draw_window(Canvas& canvas, const cv::Rect2d& area, HashStream& rng) {
  const bool dark = rng.below(2) == 0;
  const Paint ground = dark ? Paint(36, 40, 48) : Paint(244, 245, 246);
  canvas.fill(area, ground);
  canvas.fill({area.x, area.y, area.width, 0.014}, dark ? Paint(66, 72, 84) : Paint(200, 206, 214));
  canvas.text(random_words(2, rng),
              {area.x + 0.006, area.y + 0.001, 0.1, 0.012},
              dark ? Paint(220, 220, 220) : Paint(50, 50, 50));
  canvas.disc({area.x + area.width - 0.008, area.y + 0.007}, 0.004, {208, 84, 76});
  const std::vector<Paint> inks =
      dark ? std::vector<Paint>{{214, 214, 210}, {130, 190, 236}, {170, 210, 130}, {232, 170, 110}}
           : std::vector<Paint>{{44, 44, 48}, {44, 44, 48}, {60, 90, 160}, {150, 60, 60}};
  double indent = 0;
  for (double y = area.y + 0.019; y + 0.008 < area.y + area.height; y += 0.0095) {
    if (rng.below(7) == 0) {
      indent = 0.012 * rng.below(4);
      continue;
    }
    double x = area.x + 0.008 + indent;
    const double end = area.x + area.width * rng.uniform(0.3, 0.95);
    while (x < end - 0.004) {
      const double word = std::min(rng.uniform(0.008, 0.035), end - x);
      canvas.fill({x, y, word, 0.0045}, pick(inks, rng));
      x += word + 0.004;
    }
  }
}

// A window with a plot or a map.
void draw_chart_window(Canvas& canvas, const cv::Rect2d& area, HashStream& rng) {
  canvas.fill(area, {250, 250, 250});
  canvas.fill({area.x, area.y, area.width, 0.014}, {96, 120, 150});
  const cv::Rect2d inside(area.x + 0.012, area.y + 0.024, area.width - 0.024, area.height - 0.036);
  for (int i = 0; i <= 5; ++i) {
    const double y = inside.y + inside.height * i / 5.0;
    canvas.line({inside.x, y}, {inside.x + inside.width, y}, 0.001, {205, 205, 205});
  }
  for (int series = 0; series < 3; ++series) {
    const Paint ink = pick({{200, 70, 60}, {60, 110, 190}, {70, 150, 90}, {210, 150, 50}}, rng);
    std::vector<cv::Point2d> curve;
    double height = rng.uniform(0.2, 0.8);
    for (int i = 0; i <= 24; ++i) {
      height = std::clamp(height + rng.uniform(-0.12, 0.12), 0.03, 0.97);
      curve.emplace_back(inside.x + inside.width * i / 24.0, inside.y + inside.height * height);
    }
    canvas.curve(curve, 0.003, ink);
  }
  canvas.outline(inside, 0.002, {70, 70, 74});
}

// A wavy border between bands, along a spine or a cover.
void draw_title(Canvas& canvas, const cv::Rect2d& area, const Paint& ink, HashStream& rng) {
  canvas.text(random_words(1, rng), {area.x, area.y, area.width, 0.5 * area.height}, ink);
  canvas.text(random_words(1, rng),
              {area.x, area.y + 0.5 * area.height, area.width, 0.5 * area.height},
              ink);
}

Paint ink_on(const Paint& ground) {
  return ground[0] + ground[1] + ground[2] > 380 ? Paint(40, 40, 46) : Paint(236, 230, 214);
}

}  // namespace

cv::Mat3b wood_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, std::max(size_m.width, size_m.height) > 0.5 ? 0.003 : 0.004, tone);
  const bool wide = size_m.width >= size_m.height;  // the grain runs along
  canvas.noise(wide ? cv::Size2d(0.8, 0.05) : cv::Size2d(0.05, 0.8), 34.0, rng);
  canvas.noise(wide ? cv::Size2d(0.2, 0.006) : cv::Size2d(0.006, 0.2), 26.0, rng);
  const int streaks = static_cast<int>(70 * size_m.area());
  for (int i = 0; i < streaks; ++i) {
    const double y = rng.uniform(0, size_m.height), x = rng.uniform(0, size_m.width);
    const cv::Point2d at(x, y);
    const double length = rng.uniform(0.03, 0.25);
    const cv::Point2d end =
        wide ? cv::Point2d(at.x + length, at.y) : cv::Point2d(at.x, at.y + length);
    canvas.line(at, end, 0.003, blend(tone, {92, 66, 40}, rng.uniform(0.2, 0.5)));
  }
  return canvas.picture();
}

cv::Mat3b fabric_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.002, tone);
  const int rows = static_cast<int>(size_m.height / 0.006),
            columns = static_cast<int>(size_m.width / 0.006);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool over = (row + column) % 2 == 0;
      const Paint thread =
          near_color(blend(tone, over ? Paint(230, 230, 230) : Paint(0, 0, 0), 0.14), 14, rng);
      canvas.fill({0.006 * column, 0.006 * row, 0.006, over ? 0.004 : 0.006}, thread);
    }
  }
  return canvas.picture();
}

cv::Mat3b screen_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0016, pick({{52, 84, 110}, {66, 92, 84}, {88, 78, 104}}, rng));
  canvas.noise({0.2, 0.2}, 24.0, rng);
  for (int i = 0; i < 4; ++i) {  // icons
    canvas.fill({0.012, 0.02 + 0.045 * i, 0.022, 0.022}, near_color(Paint(190, 170, 120), 50, rng));
  }
  draw_window(
      canvas, {w * rng.uniform(0.08, 0.14), h * rng.uniform(0.05, 0.1), 0.48 * w, 0.78 * h}, rng);
  draw_chart_window(
      canvas, {w * rng.uniform(0.56, 0.6), h * rng.uniform(0.07, 0.15), 0.36 * w, 0.36 * h}, rng);
  draw_window(
      canvas, {w * rng.uniform(0.5, 0.6), h * rng.uniform(0.52, 0.56), 0.38 * w, 0.34 * h}, rng);
  canvas.fill({0, 0.94 * h, w, 0.06 * h}, {34, 38, 46});
  for (int i = 0; i < 6; ++i) {
    canvas.fill({0.01 + 0.028 * i, 0.95 * h, 0.016, 0.04 * h},
                near_color(Paint(130, 150, 170), 60, rng));
  }
  return canvas.picture();
}

cv::Mat3b keyboard_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  const bool dark = rng.below(2) == 0;
  Canvas canvas(size_m, 0.0015, dark ? Paint(40, 41, 44) : Paint(150, 152, 154));
  const Paint key = dark ? Paint(66, 67, 71) : Paint(222, 222, 218),
              ink = dark ? Paint(226, 226, 226) : Paint(50, 50, 54);
  constexpr int kRows = 6;
  const double pitch = h / (kRows + 0.4), unit = w / 22.5;
  for (int row = 0; row < kRows; ++row) {
    for (double x = 0.3; x < 21.6;) {
      const bool wide = row == 5 && x > 4 && x < 6;
      const double width = wide ? 6.0 : (x < 0.5 && row > 0 ? 1.0 + 0.25 * row : 1.0);
      const cv::Rect2d cap(x * unit, (row + 0.25) * pitch, (width - 0.14) * unit, 0.84 * pitch);
      canvas.fill(cap, rng.below(15) == 0 ? blend(key, {120, 124, 130}, 0.5) : key);
      const std::string label(1, static_cast<char>('A' + rng.below(26)));
      if (!wide)
        canvas.text(
            label, {cap.x + 0.15 * unit, cap.y + 0.15 * pitch, 0.6 * unit, 0.55 * pitch}, ink);
      x += width + (std::abs(x + width - 16) < 0.6 ? 0.8 : 0.0);
    }
  }
  return canvas.picture();
}

cv::Mat3b phone_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.002, {58, 60, 64});
  canvas.fill({0.4 * w, 0.08 * h, 0.54 * w, 0.24 * h}, {150, 168, 148});
  canvas.text(std::to_string(1000 + rng.below(9000)),
              {0.45 * w, 0.12 * h, 0.4 * w, 0.15 * h},
              {40, 50, 40});
  for (int i = 0; i < 12; ++i) {
    const cv::Rect2d key(
        (0.42 + 0.18 * (i % 3)) * w, (0.4 + 0.14 * (i / 3)) * h, 0.13 * w, 0.1 * h);
    canvas.fill(key, {206, 206, 202});
    canvas.text(
        std::to_string((i + 1) % 10), {key.x + 0.03 * w, key.y, 0.08 * w, 0.1 * h}, {30, 30, 30});
  }
  return canvas.picture();
}

cv::Mat3b paper_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0022, {233, 232, 227});
  canvas.text(random_words(2, rng), {0.1 * w, 0.06 * h, 0.7 * w, 0.05 * h}, {30, 30, 34});
  const double split = h * rng.uniform(0.35, 0.6);
  canvas.small_print({0.1 * w, 0.14 * h, 0.8 * w, split - 0.16 * h}, 0.011, {60, 60, 64}, rng);
  if (rng.below(3) > 0) {
    draw_chart_window(canvas, {0.12 * w, split, 0.76 * w, 0.22 * h}, rng);
    canvas.small_print(
        {0.1 * w, split + 0.25 * h, 0.8 * w, 0.68 * h - split}, 0.011, {60, 60, 64}, rng);
  } else {
    canvas.small_print({0.1 * w, split, 0.8 * w, 0.92 * h - split}, 0.011, {60, 60, 64}, rng);
  }
  if (rng.below(3) == 0)
    canvas.disc({0.7 * w, 0.8 * h}, 0.035, blend({247, 246, 241}, {150, 110, 70}, 0.25));
  return canvas.picture();
}

cv::Mat3b book_cover_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0025, tone);
  const Paint ink = ink_on(tone);
  const Paint second = near_color(blend(tone, ink, 0.35), 30, rng);
  canvas.fill({0, rng.uniform(0.3, 0.6) * h, w, rng.uniform(0.1, 0.35) * h}, second);
  const cv::Point2d center(0.5 * w, rng.uniform(0.5, 0.7) * h);
  for (int i = 0; i < 7; ++i) {
    const double y = center.y + h * rng.uniform(-0.15, 0.15);
    const cv::Point2d at(center.x + w * rng.uniform(-0.3, 0.3), y);
    const Paint third = near_color(blend(second, {200, 150, 90}, 0.6), 40, rng);
    if (rng.below(2) == 0) {
      canvas.disc(at, rng.uniform(0.03, 0.12) * w, third);
    } else {
      canvas.fill({at.x, at.y, rng.uniform(0.05, 0.25) * w, rng.uniform(0.03, 0.12) * h}, third);
    }
  }
  draw_title(canvas, {0.08 * w, 0.08 * h, 0.84 * w, 0.2 * h}, ink, rng);
  canvas.text(random_words(2, rng), {0.2 * w, 0.88 * h, 0.6 * w, 0.06 * h}, ink);
  return canvas.picture();
}

cv::Mat3b book_spine_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  // Drawn lying, as the title runs, then turned upright.
  const double w = size_m.height, h = size_m.width;
  Canvas canvas({w, h}, 0.002, tone);
  const Paint ink = ink_on(tone), second = near_color(blend(tone, ink, 0.5), 40, rng);
  if (rng.below(2) == 0) canvas.fill({0.04 * w, 0, 0.03 * w, h}, second);
  if (rng.below(2) == 0) canvas.fill({0.9 * w, 0, 0.04 * w, h}, second);
  if (rng.below(3) == 0) canvas.fill({0.12 * w, 0.08 * h, 0.6 * w, 0.84 * h}, second);
  const Paint letters = rng.below(3) == 0 ? Paint(228, 196, 110) : ink;
  canvas.text(random_words(2, rng), {0.15 * w, 0.2 * h, 0.5 * w, 0.6 * h}, letters);
  if (rng.below(2) == 0) canvas.disc({0.82 * w, 0.5 * h}, 0.25 * h, ink);
  cv::Mat3b upright(canvas.picture().cols, canvas.picture().rows);
  for (int y = 0; y < upright.rows; ++y) {
    for (int x = 0; x < upright.cols; ++x) {
      upright(y, x) = canvas.picture()(upright.cols - 1 - x, y);
    }
  }
  return upright;
}

cv::Mat3b page_edges_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.003, {232, 226, 208});
  const bool wide = size_m.width > size_m.height;
  canvas.noise(wide ? cv::Size2d(0.3, 0.006) : cv::Size2d(0.006, 0.3), 40.0, rng);
  return canvas.picture();
}

cv::Mat3b binder_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.002, tone);
  canvas.noise({0.02, 0.02}, 16.0, rng);
  canvas.fill({0.14 * w, 0.12 * h, 0.72 * w, 0.45 * h}, {242, 241, 236});
  for (int i = 0; i < 3; ++i) {
    canvas.text(
        random_words(1, rng), {0.2 * w, (0.17 + 0.1 * i) * h, 0.6 * w, 0.06 * h}, {40, 44, 54});
  }
  canvas.text(
      std::to_string(2000 + rng.below(27)), {0.2 * w, 0.48 * h, 0.6 * w, 0.06 * h}, {170, 50, 40});
  canvas.disc({0.5 * w, 0.8 * h}, 0.3 * w, {180, 182, 186});
  canvas.disc({0.5 * w, 0.8 * h}, 0.22 * w, {40, 40, 42});
  return canvas.picture();
}

cv::Mat3b mug_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0015, tone);
  const Paint ink = pick({{170, 60, 50}, {46, 80, 130}, {60, 110, 80}, {40, 40, 44}}, rng);
  for (int side = 0; side < 3; ++side) {
    const double x = w * (0.05 + 0.33 * side);
    const int kind = rng.below(3);
    if (kind == 0) canvas.text(random_words(1, rng), {x, 0.35 * h, 0.26 * w, 0.3 * h}, ink);
    if (kind == 1) {
      for (int i = 0; i < 5; ++i) {
        const Paint blob = near_color(ink, 30, rng);
        const double radius = rng.uniform(0.06, 0.16) * h;
        canvas.disc({x + 0.06 * w * i, h * rng.uniform(0.3, 0.7)}, radius, blob);
      }
    }
    if (kind == 2) {
      for (int i = 0; i < 4; ++i) canvas.fill({x, (0.2 + 0.17 * i) * h, 0.25 * w, 0.08 * h}, ink);
    }
  }
  canvas.fill({0, 0.02 * h, w, 0.05 * h}, ink);
  return canvas.picture();
}

cv::Mat3b carton_side_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  const Paint ink(92, 66, 44);
  Canvas canvas(size_m, 0.0025, {184, 146, 104});
  canvas.noise({0.006, 0.3}, 14.0, rng);
  canvas.fill({0.5 * w - 0.025, 0, 0.05, rng.uniform(0.15, 0.3) * h}, {206, 184, 146});  // tape
  canvas.text(random_words(1, rng), {0.08 * w, 0.3 * h, 0.5 * w, 0.2 * h}, ink);
  canvas.text(random_words(2, rng), {0.08 * w, 0.52 * h, 0.4 * w, 0.09 * h}, ink);
  const cv::Rect2d label(0.6 * w, rng.uniform(0.4, 0.5) * h, 0.34 * w, 0.4 * h);
  canvas.fill(label, {240, 238, 232});
  canvas.text(random_words(1, rng),
              {label.x + 0.01, label.y + 0.01, label.width - 0.02, 0.025},
              {30, 30, 34});
  for (double x = label.x + 0.01; x < label.x + label.width - 0.012; x += 0.006) {  // bar code
    if (rng.below(2) == 0)
      canvas.fill({x, label.y + 0.5 * label.height, 0.004, 0.4 * label.height}, {20, 20, 22});
  }
  for (int arrow = 0; arrow < 2; ++arrow) {  // this side up
    const cv::Point2d tip((0.12 + 0.12 * arrow) * w, 0.68 * h);
    canvas.polygon({tip, {tip.x - 0.022, tip.y + 0.03}, {tip.x + 0.022, tip.y + 0.03}}, ink);
    canvas.fill({tip.x - 0.008, tip.y + 0.03, 0.016, 0.035}, ink);
  }
  canvas.outline(canvas.bounds(), 0.004, {160, 124, 86});
  return canvas.picture();
}

cv::Mat3b carton_top_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0025, {190, 152, 110});
  canvas.noise({0.3, 0.006}, 14.0, rng);
  canvas.line({0, 0.5 * h}, {w, 0.5 * h}, 0.004, {120, 90, 60});
  canvas.fill({0, 0.5 * h - 0.025, w, 0.05}, {208, 186, 148});
  canvas.text(random_words(2, rng), {0.08 * w, 0.12 * h, 0.5 * w, 0.14 * h}, {60, 46, 40});
  canvas.fill({0.6 * w, 0.66 * h, 0.32 * w, 0.24 * h}, {238, 236, 228});
  canvas.small_print({0.62 * w, 0.69 * h, 0.28 * w, 0.2 * h}, 0.014, {60, 60, 64}, rng);
  return canvas.picture();
}

}  // namespace stillmap
