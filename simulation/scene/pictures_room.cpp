// SPDX-License-Identifier: Apache-2.0
// Pictures of pictures.hpp: the room itself.
#include "simulation/scene/canvas.hpp"
#include "simulation/scene/pictures.hpp"

namespace stillmap {
namespace {

void draw_house(Canvas& canvas, const cv::Rect2d& front, HashStream& rng) {
  const Paint wall = pick({{196, 180, 158}, {176, 120, 98}, {205, 200, 190}, {150, 152, 158}}, rng);
  canvas.fill(front, wall);
  const double roof = 0.25 * front.width;
  canvas.polygon({{front.x - 0.02, front.y},
                  {front.x + 0.5 * front.width, front.y - roof},
                  {front.x + front.width + 0.02, front.y}},
                 pick({{120, 66, 52}, {84, 84, 92}, {140, 88, 60}}, rng));
  const double pitch = rng.uniform(0.06, 0.09);
  for (double y = front.y + 0.03; y + 0.07 < front.y + front.height; y += 0.1) {
    for (double x = front.x + 0.02; x + 0.04 < front.x + front.width; x += pitch) {
      canvas.fill({x, y, 0.035, 0.055}, {235, 235, 230});
      canvas.fill({x + 0.005, y + 0.005, 0.025, 0.045}, near_color(Paint(80, 96, 112), 20, rng));
    }
  }
}

}  // namespace

cv::Mat3b plaster_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.008, {224, 221, 211});
  canvas.noise({0.9, 0.9}, 6.0, rng);
  canvas.noise({0.04, 0.04}, 7.0, rng);
  const int marks = static_cast<int>(size_m.area());
  for (int i = 0; i < marks; ++i) {  // scuffs and filled holes
    const double y = rng.uniform(0.3, 1.0) * size_m.height, x = rng.uniform(0, size_m.width);
    const cv::Point2d at(x, y);
    const double length = rng.uniform(0.01, 0.12);
    canvas.line(at, {at.x + length, at.y + rng.uniform(-0.03, 0.03)}, 0.008, {203, 199, 189});
  }
  return canvas.picture();
}

cv::Mat3b carpet_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  const Paint tone(104, 109, 116), light(130, 136, 144), dark(80, 85, 96);
  Canvas canvas(size_m, 0.006, tone);
  constexpr double kTile = 0.5;
  for (double y = 0; y < size_m.height; y += kTile) {
    for (double x = 0; x < size_m.width; x += kTile) {
      const cv::Rect2d tile(x, y, kTile, kTile);
      const double share = rng.uniform(0, 0.3);
      canvas.fill(tile, blend(tone, rng.below(2) == 0 ? light : dark, share));
      const bool across = rng.below(2) == 0;
      for (int i = 0; i < 26; ++i) {  // stripes of the pile
        const double at = rng.uniform(0, kTile - 0.02), from = rng.uniform(0, 0.3);
        const double length = rng.uniform(0.08, kTile - from);
        const cv::Rect2d stripe = across ? cv::Rect2d(x + from, y + at, length, 0.012)
                                         : cv::Rect2d(x + at, y + from, 0.012, length);
        const double strength = rng.uniform(0.1, 0.6);
        canvas.fill(stripe & tile, blend(tone, rng.below(2) == 0 ? light : dark, strength));
      }
      canvas.outline(tile, 0.006, blend(tone, {60, 64, 72}, 0.5));
    }
  }
  canvas.noise({0.05, 0.05}, 20.0, rng);
  const int crumbs = static_cast<int>(4 * size_m.area());
  for (int i = 0; i < crumbs; ++i) {
    const double y = rng.uniform(0, size_m.height), x = rng.uniform(0, size_m.width);
    const Paint crumb = near_color(Paint(140, 142, 145), 40, rng);
    canvas.disc({x, y}, rng.uniform(0.004, 0.012), crumb);
  }
  return canvas.picture();
}

cv::Mat3b ceiling_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.012, {230, 230, 226});
  constexpr double kPanel = 0.6;
  const int holes = static_cast<int>(60 * size_m.area());
  for (int i = 0; i < holes; ++i) {
    const double y = rng.uniform(0, size_m.height), x = rng.uniform(0, size_m.width);
    canvas.fill({x, y, rng.uniform(0.01, 0.03), 0.012}, {206, 206, 202});
  }
  for (double at = 0; at < size_m.width; at += kPanel) {
    canvas.fill({at, 0, 0.024, size_m.height}, {190, 190, 188});
    canvas.fill({0, at, size_m.width, 0.024}, {190, 190, 188});
  }
  canvas.noise({0.3, 0.3}, 6.0, rng);
  return canvas.picture();
}

cv::Mat3b lamp_panel_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.01, {255, 253, 246});
  for (double x = 0; x < size_m.width; x += 0.1) {
    canvas.fill({x, 0, 0.012, size_m.height}, near_color(Paint(236, 236, 230), 4, rng));
  }
  canvas.outline(canvas.bounds(), 0.012, {222, 222, 220});
  return canvas.picture();
}

cv::Mat3b outdoor_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.005, {186, 208, 234});
  canvas.noise({0.7, 0.16}, 50.0, rng);  // clouds
  const double horizon = 0.62 * size_m.height;
  canvas.fill({0, horizon, size_m.width, size_m.height - horizon}, {118, 138, 92});
  for (double x = -0.05; x < size_m.width;) {
    const double width = rng.uniform(0.16, 0.34), height = rng.uniform(0.2, 0.42);
    draw_house(canvas, {x, horizon + 0.06 - height, width, height}, rng);
    x += width + rng.uniform(0.02, 0.12);
  }
  for (int tree = 0; tree < 9; ++tree) {
    const double ground = horizon + rng.uniform(0.05, 0.14);
    const cv::Point2d foot(rng.uniform(0, size_m.width), ground);
    const double height = rng.uniform(0.1, 0.3);
    canvas.line(foot, {foot.x, foot.y - height}, 0.015, {84, 66, 50});
    for (int leaf = 0; leaf < 14; ++leaf) {
      const double y = foot.y - height * rng.uniform(0.5, 1.3);
      const double x = foot.x + rng.uniform(-0.4, 0.4) * height;
      const Paint green = near_color(Paint(74, 104, 58), 18, rng);
      canvas.disc({x, y}, rng.uniform(0.06, 0.2) * height, green);
    }
  }
  const double street = 0.87 * size_m.height;
  canvas.fill({0, street, size_m.width, size_m.height}, {128, 128, 130});
  for (double x = 0; x < size_m.width; x += 0.16) {
    canvas.fill({x, street + 0.07, 0.09, 0.012}, {220, 220, 214});
  }
  return canvas.picture();
}

cv::Mat3b door_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.005, {196, 172, 138});
  canvas.noise({0.04, 0.9}, 26.0, rng);
  canvas.noise({0.01, 0.2}, 14.0, rng);
  for (const double top : {0.12, 0.56}) {  // two panels let in
    const cv::Rect2d panel(0.13 * size_m.width,
                           top * size_m.height,
                           0.74 * size_m.width,
                           (top < 0.5 ? 0.36 : 0.34) * size_m.height);
    canvas.outline(panel, 0.02, {150, 126, 96});
    canvas.outline({panel.x + 0.02, panel.y + 0.02, panel.width - 0.04, panel.height - 0.04},
                   0.008,
                   {216, 196, 164});
  }
  canvas.fill({0.36 * size_m.width, 0.05 * size_m.height, 0.26, 0.08}, {236, 236, 234});
  canvas.text("Room " + std::to_string(100 + rng.below(300)),
              {0.38 * size_m.width, 0.053 * size_m.height, 0.2, 0.06},
              {50, 54, 64});
  return canvas.picture();
}

cv::Mat3b socket_picture(cv::Size2d size_m, PictureSeed seed) {
  HashStream rng(seed);
  Canvas canvas(size_m, 0.002, {240, 240, 236});
  canvas.outline(canvas.bounds(), 0.003, {200, 200, 196});
  const int places = std::max(1, static_cast<int>(size_m.width / size_m.height + 0.5));
  const double pitch = size_m.width / places, side = size_m.height;
  for (int i = 0; i < places; ++i) {
    const cv::Point2d center((i + 0.5) * pitch, 0.5 * side);
    canvas.disc(center, 0.34 * side, {206, 206, 202});
    canvas.disc(center, 0.3 * side, near_color(Paint(226, 226, 222), 5, rng));
    canvas.disc({center.x - 0.12 * side, center.y}, 0.05 * side, {60, 60, 60});
    canvas.disc({center.x + 0.12 * side, center.y}, 0.05 * side, {60, 60, 60});
  }
  return canvas.picture();
}

}  // namespace stillmap
