// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {

/// Red, green and blue.
using Paint = cv::Vec3b;

/// A colour between two.
[[nodiscard]] Paint blend(const Paint& a, const Paint& b, double share_of_b);

/// A colour near another: each of its brightness and channels differs by at most `spread`.
[[nodiscard]] Paint near_color(const Paint& color, int spread, HashStream& rng);

/// One of a few colours.
[[nodiscard]] Paint pick(const std::vector<Paint>& colors, HashStream& rng);

/// Words of office life, separated by spaces.
[[nodiscard]] std::string random_words(int count, HashStream& rng);

/// A picture that is drawn on in metres, from its top left corner: x right, y down.
class Canvas {
 public:
  Canvas(cv::Size2d size_m, double texel_m, const Paint& color);

  [[nodiscard]] const cv::Mat3b& picture() const { return picture_; }
  [[nodiscard]] cv::Rect2d bounds() const { return {{0, 0}, size_m_}; }

  void fill(const cv::Rect2d& area, const Paint& color);
  void outline(const cv::Rect2d& area, double width_m, const Paint& color);
  void line(cv::Point2d from, cv::Point2d to, double width_m, const Paint& color);
  void curve(const std::vector<cv::Point2d>& points, double width_m, const Paint& color);
  void polygon(const std::vector<cv::Point2d>& corners, const Paint& color);
  void disc(cv::Point2d center, double radius_m, const Paint& color);

  /// One line of letters in the height of `area`, reduced if it is too long.
  void text(const std::string& words, const cv::Rect2d& area, const Paint& ink);

  /// Print too small to read: lines of word-like dashes.
  void small_print(const cv::Rect2d& area, double line_m, const Paint& ink, HashStream& rng);

  /// Adds noise of several octaves, each half as coarse as the one before, of `contrast` grey
  /// values.
  void noise(cv::Size2d cell_m, double contrast, HashStream& rng);

  /// Copies another picture into an area.
  void paste(const cv::Mat3b& other, const cv::Rect2d& area);

 private:
  [[nodiscard]] cv::Point shifted(cv::Point2d place) const;
  [[nodiscard]] int texels(double metres) const;
  [[nodiscard]] cv::Rect texel_rect(const cv::Rect2d& area) const;

  cv::Size2d size_m_;
  double texel_m_;
  cv::Mat3b picture_;
};

}  // namespace stillmap
