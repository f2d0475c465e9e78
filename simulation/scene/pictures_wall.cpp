// SPDX-License-Identifier: Apache-2.0
// Pictures of pictures.hpp: things on the walls.
#include <cmath>
#include <numbers>

#include "simulation/scene/canvas.hpp"
#include "simulation/scene/pictures.hpp"

namespace stillmap {
namespace {

const std::vector<Paint> kPens{{36, 66, 140}, {40, 40, 44}, {176, 46, 44}, {36, 116, 70}};
const std::vector<Paint> kNotes{{240, 220, 110}, {238, 170, 176}, {160, 212, 160}, {150, 196, 226}};
const std::vector<Paint> kInks{{44, 84, 140}, {176, 74, 50}, {70, 130, 92}, {150, 110, 40}};

// A blob with a ragged coast: a continent, a lake.
std::vector<cv::Point2d> ragged_blob(cv::Point2d center, cv::Size2d radius, HashStream& rng) {
  constexpr int kCorners = 44;
  std::vector<cv::Point2d> corners;
  const double a = rng.uniform(0, 6.3), b = rng.uniform(0, 6.3);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    const double wide = 0.72 + 0.18 * std::sin(2 * angle + a) + 0.14 * std::sin(5 * angle + b) +
                        rng.uniform(-0.1, 0.1);
    corners.emplace_back(center.x + radius.width * wide * std::cos(angle),
                         center.y + radius.height * wide * std::sin(angle));
  }
  return corners;
}

// A plot with axes and a few curves or bars.
void draw_plot(Canvas& canvas, const cv::Rect2d& area, HashStream& rng) {
  const double unit = std::min(area.width, area.height);
  canvas.fill(area, {250, 250, 248});
  const cv::Point2d zero(area.x + 0.1 * unit, area.y + area.height - 0.1 * unit);
  const cv::Size2d span(area.width - 0.18 * unit, area.height - 0.18 * unit);
  for (int i = 1; i < 6; ++i) {
    const double y = zero.y - span.height * i / 6;
    canvas.line({zero.x, y}, {zero.x + span.width, y}, 0.004 * unit, {214, 214, 214});
  }
  const bool bars = rng.below(2) == 0;
  const int series = bars ? 1 : 3;
  for (int s = 0; s < series; ++s) {
    const Paint color = pick(kInks, rng);
    std::vector<cv::Point2d> curve;
    double height = rng.uniform(0.1, 0.9);
    for (int i = 0; i <= 12; ++i) {
      height = std::clamp(height + rng.uniform(-0.2, 0.2), 0.05, 0.95);
      curve.emplace_back(zero.x + span.width * i / 12.5, zero.y - span.height * height);
      const double top = curve.back().y;
      if (bars) canvas.fill({curve.back().x, top, span.width / 20, zero.y - top}, color);
    }
    if (!bars) canvas.curve(curve, 0.018 * unit, color);
  }
  canvas.line(zero, {zero.x + span.width, zero.y}, 0.014 * unit, {50, 50, 50});
  canvas.line(zero, {zero.x, zero.y - span.height}, 0.014 * unit, {50, 50, 50});
}

// A small photograph: sky, mountains behind one another, water or a field.
void draw_landscape(Canvas& canvas, const cv::Rect2d& area, HashStream& rng) {
  const Paint sky = pick({{176, 204, 228}, {232, 190, 150}, {150, 176, 206}}, rng);
  for (int i = 0; i < 12; ++i) {
    const double top = area.height * i / 12.0;
    canvas.fill({area.x, area.y + top, area.width, area.height - top},
                blend(sky, {246, 236, 220}, i / 14.0));
  }
  canvas.disc({area.x + area.width * rng.uniform(0.2, 0.8), area.y + 0.2 * area.height},
              0.06 * area.height,
              {250, 240, 205});
  for (int ridge = 0; ridge < 4; ++ridge) {
    std::vector<cv::Point2d> corners{{area.x, area.y + area.height}};
    double y = area.y + area.height * (0.34 + 0.13 * ridge);
    const double low = area.y + area.height * (0.5 + 0.13 * ridge);
    for (int i = 0; i <= 24; ++i) {
      y = std::clamp(y + area.height * rng.uniform(-0.06, 0.06), area.y + 0.22 * area.height, low);
      corners.emplace_back(area.x + area.width * i / 24.0, y);
    }
    corners.emplace_back(area.x + area.width, area.y + area.height);
    canvas.polygon(corners, blend({140, 156, 172}, {46, 66, 48}, 0.12 + 0.26 * ridge));
  }
  for (int i = 0; i < 30; ++i) {  // trees
    const double x = area.x + area.width * rng.uniform(0.02, 0.98);
    const double foot = area.y + area.height * rng.uniform(0.88, 0.99);
    const double height = area.height * rng.uniform(0.06, 0.16);
    canvas.polygon({{x - 0.25 * height, foot}, {x, foot - height}, {x + 0.25 * height, foot}},
                   near_color(Paint(38, 60, 40), 14, rng));
  }
}

// Handwriting: a wavy line, in words.
void scribble(Canvas& canvas, const cv::Rect2d& line, const Paint& ink, HashStream& rng) {
  const double step = 0.16 * line.height;
  std::vector<cv::Point2d> stroke;
  for (double x = line.x; x < line.x + line.width; x += step) {
    const bool tall = rng.below(5) == 0;
    stroke.emplace_back(x, line.y + line.height * (tall ? 0.05 : rng.uniform(0.35, 0.95)));
    if (rng.below(9) == 0) {
      canvas.curve(stroke, 0.05 * line.height, ink);
      stroke.clear();
      x += 3 * step;
    }
  }
  canvas.curve(stroke, 0.05 * line.height, ink);
}

}  // namespace

cv::Mat3b world_map_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.003, {178, 204, 220});
  const double w = size_m.width, h = size_m.height;
  for (int i = 1; i < 12; ++i)
    canvas.line({w * i / 12, 0}, {w * i / 12, h}, 0.002, {150, 180, 200});
  for (int i = 1; i < 6; ++i) canvas.line({0, h * i / 6}, {w, h * i / 6}, 0.002, {150, 180, 200});
  const std::vector<Paint> lands{
      {214, 196, 140}, {176, 190, 136}, {222, 178, 140}, {200, 170, 170}, {226, 214, 170}};
  const std::vector<cv::Rect2d> continents{{0.22, 0.32, 0.15, 0.22},
                                           {0.31, 0.70, 0.08, 0.24},
                                           {0.50, 0.62, 0.10, 0.24},
                                           {0.52, 0.28, 0.09, 0.14},
                                           {0.70, 0.34, 0.18, 0.25},
                                           {0.84, 0.74, 0.08, 0.11},
                                           {0.38, 0.14, 0.06, 0.09},
                                           {0.5, 0.97, 0.44, 0.05}};
  for (const cv::Rect2d& c : continents) {
    const cv::Point2d center(c.x * w, c.y * h);
    const Paint land = pick(lands, rng);
    canvas.polygon(ragged_blob(center, {1.2 * c.width * w, 1.15 * c.height * h}, rng), land);
    for (int country = 0; country < 8; ++country) {
      const double y = center.y + c.height * h * rng.uniform(-0.5, 0.5);
      const cv::Point2d at(center.x + c.width * w * rng.uniform(-0.5, 0.5), y);
      const Paint tone = pick(lands, rng);
      canvas.polygon(ragged_blob(at, {0.04 * w, 0.05 * h}, rng), tone);
      canvas.disc(at, 0.004, {60, 60, 60});
      canvas.text(random_words(1, rng), {at.x + 0.01, at.y - 0.01, 0.06, 0.016}, {70, 62, 56});
    }
  }
  canvas.text("THE WORLD", {0.4 * w, 0.015 * h, 0.2 * w, 0.06 * h}, {70, 70, 80});
  canvas.outline(canvas.bounds(), 0.02, {240, 238, 230});
  canvas.outline({0.018, 0.018, w - 0.036, h - 0.036}, 0.005, {96, 100, 110});
  return canvas.picture();
}

cv::Mat3b landscape_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.003, {244, 243, 238});
  const double edge = 0.09 * std::min(size_m.width, size_m.height);
  draw_landscape(canvas, {edge, edge, size_m.width - 2 * edge, size_m.height - 2 * edge}, rng);
  canvas.noise({0.03, 0.03}, 12.0, rng);
  canvas.outline(canvas.bounds(), edge, {244, 243, 238});
  return canvas.picture();
}

cv::Mat3b abstract_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const std::vector<Paint> tones{
      {188, 92, 66}, {52, 76, 96}, {214, 178, 108}, {96, 128, 122}, {232, 222, 204}, {60, 56, 58}};
  Canvas canvas(size_m, 0.003, {236, 228, 212});
  for (int i = 0; i < 13; ++i) {
    const double y = rng.uniform(0.1, 0.9) * size_m.height;
    const cv::Point2d at(rng.uniform(0.1, 0.9) * size_m.width, y);
    const double side = rng.uniform(0.05, 0.25) * size_m.width;
    const Paint tone = pick(tones, rng);
    const int kind = rng.below(4);
    if (kind == 0) canvas.disc(at, side, tone);
    if (kind == 1)
      canvas.fill({at.x - side, at.y - side, 2 * side, rng.uniform(0.3, 2) * side}, tone);
    if (kind == 2) canvas.polygon(ragged_blob(at, {side, side}, rng), tone);
    if (kind == 3) {
      canvas.line(at, {rng.uniform(0, size_m.width), rng.uniform(0, size_m.height)}, 0.012, tone);
    }
  }
  canvas.noise({0.06, 0.06}, 16.0, rng);
  canvas.outline(canvas.bounds(), 0.05, {242, 240, 234});
  return canvas.picture();
}

cv::Mat3b science_poster_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0025, {246, 246, 243});
  const Paint theme = pick({{44, 72, 118}, {116, 44, 52}, {40, 92, 84}, {84, 60, 112}}, rng);
  canvas.fill({0, 0, w, 0.14 * h}, theme);
  canvas.text(random_words(3, rng), {0.05 * w, 0.025 * h, 0.9 * w, 0.06 * h}, {245, 245, 240});
  canvas.text(random_words(5, rng), {0.05 * w, 0.09 * h, 0.7 * w, 0.03 * h}, {214, 218, 226});
  for (int column = 0; column < 2; ++column) {
    const double x = (0.05 + 0.47 * column) * w, width = 0.43 * w;
    for (double y = 0.17 * h; y < 0.8 * h;) {
      canvas.text(random_words(2, rng), {x, y, width, 0.03 * h}, theme);
      y += 0.035 * h;
      const double text = h * rng.uniform(0.06, 0.12);
      canvas.small_print({x, y, width, text}, 0.014, {70, 70, 74}, rng);
      y += text + 0.01 * h;
      const double plot = h * rng.uniform(0.14, 0.2);
      if (y + plot > 0.95 * h) break;
      if (rng.below(3) == 0) {
        draw_landscape(canvas, {x, y, width, plot}, rng);
      } else {
        draw_plot(canvas, {x, y, width, plot}, rng);
      }
      y += plot + 0.02 * h;
    }
  }
  canvas.fill({0, 0.965 * h, w, 0.035 * h}, theme);
  return canvas.picture();
}

cv::Mat3b calendar_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.0025, {248, 248, 246});
  draw_landscape(canvas, {0, 0, w, 0.45 * h}, rng);
  canvas.text(pick({{0, 0, 0}, {1, 0, 0}}, rng)[0] == 0 ? "SEPTEMBER" : "MARCH",
              {0.06 * w, 0.47 * h, 0.6 * w, 0.07 * h},
              {150, 40, 40});
  const int first = rng.below(7);
  for (int day = 1; day <= 31; ++day) {
    const int cell = first + day - 1;
    const cv::Rect2d place(
        (0.05 + 0.13 * (cell % 7)) * w, (0.57 + 0.07 * (cell / 7)) * h, 0.09 * w, 0.05 * h);
    if (rng.below(9) == 0)
      canvas.disc({place.x + 0.03 * w, place.y + 0.025 * h}, 0.04 * w, {238, 190, 90});
    canvas.text(std::to_string(day), place, cell % 7 > 4 ? Paint(180, 50, 50) : Paint(50, 50, 54));
  }
  return canvas.picture();
}

cv::Mat3b clock_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double r = 0.5 * std::min(size_m.width, size_m.height);
  Canvas canvas(size_m, 0.002, {248, 248, 244});
  const auto at = [&](double turn, double radius) {
    const double angle = 2.0 * std::numbers::pi * turn;
    return cv::Point2d(r + radius * r * std::sin(angle), r - radius * r * std::cos(angle));
  };
  for (int hour = 0; hour < 12; ++hour) {
    canvas.line(at(hour / 12.0, 0.72), at(hour / 12.0, 0.86), 0.05 * r, {36, 36, 38});
    const cv::Point2d label = at(hour / 12.0, 0.55);
    canvas.text(std::to_string(hour == 0 ? 12 : hour),
                {label.x - 0.09 * r, label.y - 0.1 * r, 0.25 * r, 0.2 * r},
                {50, 50, 54});
  }
  const double time = rng.uniform(0, 1);
  canvas.line({r, r}, at(time, 0.42), 0.07 * r, {24, 24, 26});
  canvas.line({r, r}, at(12 * time, 0.68), 0.05 * r, {24, 24, 26});
  canvas.line({r, r}, at(rng.uniform(0, 1), 0.72), 0.02 * r, {190, 40, 40});
  return canvas.picture();
}

cv::Mat3b whiteboard_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const double w = size_m.width, h = size_m.height;
  Canvas canvas(size_m, 0.003, {240, 242, 242});
  canvas.noise({0.5, 0.2}, 6.0, rng);
  for (int row = 0; row < 6; ++row) {
    const Paint pen = pick(kPens, rng);
    scribble(canvas,
             {0.05 * w, (0.06 + 0.075 * row) * h, w * rng.uniform(0.2, 0.42), 0.05 * h},
             pen,
             rng);
  }
  std::vector<cv::Point2d> boxes;
  for (int i = 0; i < 6; ++i) {  // a diagram of boxes and arrows
    const cv::Point2d at((0.55 + 0.22 * (i % 2)) * w, (0.1 + 0.17 * (i / 2)) * h);
    canvas.outline({at.x, at.y, 0.15 * w, 0.1 * h}, 0.006, pick(kPens, rng));
    canvas.text(
        random_words(1, rng), {at.x + 0.02 * w, at.y + 0.03 * h, 0.11 * w, 0.045 * h}, kPens[1]);
    boxes.emplace_back(at.x + 0.075 * w, at.y + 0.05 * h);
  }
  for (std::size_t i = 0; i + 2 < boxes.size(); ++i) {
    const cv::Point2d from = boxes[i] + cv::Point2d(0, 0.05 * h),
                      to = boxes[i + 2] - cv::Point2d(0, 0.05 * h);
    canvas.line(from, to, 0.005, kPens[0]);
    canvas.polygon({to, {to.x - 0.012, to.y - 0.02}, {to.x + 0.012, to.y - 0.02}}, kPens[0]);
  }
  draw_plot(canvas, {0.06 * w, 0.56 * h, 0.34 * w, 0.36 * h}, rng);
  for (int i = 0; i < 7; ++i) {
    const double y = h * rng.uniform(0.62, 0.84);
    const cv::Rect2d note(w * rng.uniform(0.45, 0.9), y, 0.076, 0.076);
    canvas.fill(note, near_color(pick(kNotes, rng), 8, rng));
    for (int row = 0; row < 3; ++row) {
      scribble(canvas, {note.x + 0.008, note.y + 0.01 + 0.02 * row, 0.055, 0.016}, kPens[1], rng);
    }
  }
  return canvas.picture();
}

cv::Mat3b pinboard_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.003, {190, 152, 108});
  canvas.noise({0.02, 0.02}, 50.0, rng);
  const int sheets = static_cast<int>(14 * size_m.area());
  for (int i = 0; i < sheets; ++i) {
    const double side = rng.uniform(0.08, 0.22);
    const double height = side * rng.uniform(0.7, 1.3);
    const double y = rng.uniform(0.02, size_m.height - 1.3 * side);
    const cv::Rect2d sheet(rng.uniform(0.02, size_m.width - side - 0.02), y, side, height);
    canvas.fill({sheet.x + 0.006, sheet.y + 0.006, sheet.width, sheet.height}, {130, 100, 70});
    const bool note = side < 0.11;
    canvas.fill(sheet, note ? pick(kNotes, rng) : Paint(246, 245, 240));
    const cv::Rect2d inside(
        sheet.x + 0.012, sheet.y + 0.02, sheet.width - 0.024, sheet.height - 0.03);
    const int kind = rng.below(3);
    if (note || kind == 0) {
      const Paint pen = pick(kPens, rng);
      canvas.text(random_words(1, rng), {inside.x, inside.y, inside.width, 0.022}, pen);
      canvas.small_print({inside.x, inside.y + 0.03, inside.width, inside.height - 0.03},
                         0.012,
                         {80, 80, 84},
                         rng);
    } else if (kind == 1) {
      draw_plot(canvas, inside, rng);
    } else {
      draw_landscape(canvas, inside, rng);
    }
    canvas.disc({sheet.x + 0.5 * sheet.width, sheet.y + 0.008}, 0.007, pick(kInks, rng));
  }
  return canvas.picture();
}

}  // namespace stillmap
