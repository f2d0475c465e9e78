// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kShift = 4;  // positions are drawn with 1/16 of a texel

cv::Scalar scalar(const Paint& c) {
  return {double(c[0]), double(c[1]), double(c[2])};
}

constexpr std::array<const char*, 56> kWords{
    "annual", "notes",  "system",  "theory",   "design",  "report",  "garden",  "field",
    "optics", "signal", "matter",  "history",  "atlas",   "modern",  "review",  "matrix",
    "ocean",  "manual", "project", "volume",   "code",    "vision",  "maps",    "meeting",
    "robots", "linear", "plan",    "budget",   "archive", "lecture", "control", "energy",
    "rivers", "motion", "sensor",  "basics",   "print",   "fragile", "north",   "paper",
    "method", "primer", "light",   "geometry", "travel",  "guide",   "data",    "summer",
    "music",  "camera", "graphs",  "number",   "image",   "filter",  "space",   "index"};

// One octave of value noise: random values on a lattice, interpolated.
cv::Mat1b value_noise(cv::Size size, cv::Size cell, std::uint64_t seed) {
  HashStream rng(seed);
  cv::Mat1b values(size.height / cell.height + 2, size.width / cell.width + 2);
  for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(rng.bits() >> 56U);
  cv::Mat1b noise;
  cv::resize(values, noise, size, 0, 0, cv::INTER_LINEAR);
  return noise;
}

}  // namespace

Paint blend(const Paint& a, const Paint& b, double share_of_b) {
  Paint mixed;
  for (int i = 0; i < 3; ++i) {
    mixed[i] = cv::saturate_cast<std::uint8_t>((1.0 - share_of_b) * a[i] + share_of_b * b[i]);
  }
  return mixed;
}

Paint near_color(const Paint& color, int spread, HashStream& rng) {
  const int brightness = rng.below(2 * spread + 1) - spread;
  Paint near;
  for (int i = 0; i < 3; ++i) {
    const int own = rng.below(spread + 1) - spread / 2;
    near[i] = cv::saturate_cast<std::uint8_t>(color[i] + brightness + own);
  }
  return near;
}

Paint pick(const std::vector<Paint>& colors, HashStream& rng) {
  return colors[static_cast<std::size_t>(rng.below(static_cast<int>(colors.size())))];
}

std::string random_words(int count, HashStream& rng) {
  std::string words;
  for (int i = 0; i < count; ++i) {
    if (i > 0) words += ' ';
    words += kWords[static_cast<std::size_t>(rng.below(static_cast<int>(kWords.size())))];
  }
  return words;
}

Canvas::Canvas(cv::Size2d size_m, double texel_m, const Paint& color)
    : size_m_(size_m), texel_m_(texel_m) {
  STILLMAP_CHECK(size_m.width > 0 && size_m.height > 0 && texel_m > 0);
  picture_ = cv::Mat3b(texels(size_m.height), texels(size_m.width), color);
}

int Canvas::texels(double metres) const {
  return std::max(1, static_cast<int>(std::lround(metres / texel_m_)));
}

cv::Point Canvas::shifted(cv::Point2d place) const {
  constexpr double kUnits = 1 << kShift;
  // Integer positions are the centres of texels.
  return {static_cast<int>(std::lround((place.x / texel_m_ - 0.5) * kUnits)),
          static_cast<int>(std::lround((place.y / texel_m_ - 0.5) * kUnits))};
}

cv::Rect Canvas::texel_rect(const cv::Rect2d& area) const {
  const int left = static_cast<int>(std::lround(area.x / texel_m_));
  const int top = static_cast<int>(std::lround(area.y / texel_m_));
  const cv::Rect rect(left, top, texels(area.width), texels(area.height));
  return rect & cv::Rect(0, 0, picture_.cols, picture_.rows);
}

void Canvas::fill(const cv::Rect2d& area, const Paint& color) {
  const cv::Rect rect = texel_rect(area);
  if (!rect.empty()) picture_(rect).setTo(scalar(color));
}

void Canvas::outline(const cv::Rect2d& area, double width_m, const Paint& color) {
  fill({area.x, area.y, area.width, width_m}, color);
  fill({area.x, area.y + area.height - width_m, area.width, width_m}, color);
  fill({area.x, area.y, width_m, area.height}, color);
  fill({area.x + area.width - width_m, area.y, width_m, area.height}, color);
}

void Canvas::line(cv::Point2d from, cv::Point2d to, double width_m, const Paint& color) {
  cv::line(
      picture_, shifted(from), shifted(to), scalar(color), texels(width_m), cv::LINE_AA, kShift);
}

void Canvas::curve(const std::vector<cv::Point2d>& points, double width_m, const Paint& color) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    line(points[i], points[i + 1], width_m, color);
  }
}

void Canvas::polygon(const std::vector<cv::Point2d>& corners, const Paint& color) {
  std::vector<cv::Point> places;
  for (const cv::Point2d& corner : corners) places.push_back(shifted(corner));
  cv::fillPoly(
      picture_, std::vector<std::vector<cv::Point>>{places}, scalar(color), cv::LINE_AA, kShift);
}

void Canvas::disc(cv::Point2d center, double radius_m, const Paint& color) {
  const int radius = static_cast<int>(std::lround(radius_m / texel_m_ * (1 << kShift)));
  cv::circle(picture_, shifted(center), radius, scalar(color), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::text(const std::string& words, const cv::Rect2d& area, const Paint& ink) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  constexpr double kCapHeight = 22.0;  // of this font at scale 1
  const cv::Size unit = cv::getTextSize(words, kFont, 1.0, 1, nullptr);
  const double by_height = 0.8 * area.height / texel_m_ / kCapHeight;
  const double scale = std::min(by_height, area.width / texel_m_ / std::max(1, unit.width));
  const int thickness = std::max(1, static_cast<int>(std::lround(2.2 * scale)));
  const cv::Point origin(static_cast<int>(std::lround(area.x / texel_m_)),
                         static_cast<int>(std::lround((area.y + 0.8 * area.height) / texel_m_)));
  cv::putText(picture_, words, origin, kFont, scale, scalar(ink), thickness, cv::LINE_AA);
}

void Canvas::small_print(const cv::Rect2d& area, double line_m, const Paint& ink, HashStream& rng) {
  for (double y = area.y; y + line_m <= area.y + area.height; y += line_m) {
    const bool last = rng.below(6) == 0;  // of a paragraph
    const double end = area.x + area.width * (last ? rng.uniform(0.3, 0.7) : rng.uniform(0.9, 1.0));
    double x = area.x;
    while (x < end) {
      const double word = std::min(line_m * rng.uniform(0.6, 3.0), end - x);
      const Paint tone = blend(ink, picture_(picture_.rows / 2, 0), rng.uniform(0.0, 0.3));
      fill({x, y + 0.2 * line_m, word, 0.5 * line_m}, tone);
      x += word + 0.5 * line_m;
    }
  }
}

void Canvas::noise(cv::Size2d cell_m, double contrast, HashStream& rng) {
  cv::Mat1s sum = cv::Mat1s::zeros(picture_.size());
  double share = 0.5;
  while (std::max(cell_m.width, cell_m.height) > 1.5 * texel_m_ && share > 0.05) {
    const cv::Size cell(texels(cell_m.width), texels(cell_m.height));
    const cv::Mat1b octave = value_noise(picture_.size(), cell, rng.bits());
    cv::Mat1s scaled;
    octave.convertTo(scaled, CV_16S, contrast * share / 127.5, -contrast * share);
    sum += scaled;
    cell_m = cell_m * 0.5;
    share *= 0.7;
  }
  for (int y = 0; y < sum.rows; ++y) {
    for (int x = 0; x < sum.cols; ++x) {
      Paint& c = picture_(y, x);
      for (int i = 0; i < 3; ++i) c[i] = cv::saturate_cast<std::uint8_t>(c[i] + sum(y, x));
    }
  }
}

void Canvas::paste(const cv::Mat3b& other, const cv::Rect2d& area) {
  const cv::Rect rect = texel_rect(area);
  if (rect.empty()) return;
  cv::Mat3b fitted;
  cv::resize(other, fitted, rect.size(), 0, 0, cv::INTER_AREA);
  fitted.copyTo(picture_(rect));
}

}  // namespace stillmap
