// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

namespace stillmap {

/// An image with the time at which it was taken, by the device's clock.
template <class Image>
struct TimedImage {
  double stamp_s = 0;
  Image image;
};

/// Colour and depth images that wait for their partner: colour may come some frames after the depth
/// of its moment, or before it.
template <class Color, class Depth>
class ImagePairs {
 public:
  using Pair = std::pair<TimedImage<Color>, TimedImage<Depth>>;

  void add_color(double stamp_s, Color image) { add(color_, {stamp_s, std::move(image)}); }
  void add_depth(double stamp_s, Depth image) { add(depth_, {stamp_s, std::move(image)}); }

  /// The newest colour image that has a depth image within `same_time_s` of it, with the nearest;
  /// both and what is older go. Nothing where there is none.
  [[nodiscard]] std::optional<Pair> take(double same_time_s) {
    for (std::size_t i = color_.size(); i-- > 0;) {
      std::optional<std::size_t> nearest;
      double nearest_s = same_time_s;
      for (std::size_t j = depth_.size(); j-- > 0;) {
        const double apart_s = std::abs(color_[i].stamp_s - depth_[j].stamp_s);
        if (!(apart_s <= nearest_s)) continue;
        nearest = j;
        nearest_s = apart_s;
      }
      if (!nearest) continue;
      Pair pair(std::move(color_[i]), std::move(depth_[*nearest]));
      erase_through(color_, i);
      erase_through(depth_, *nearest);
      return pair;
    }
    return std::nullopt;
  }

  void clear() {
    color_.clear();
    depth_.clear();
  }

 private:
  template <class Image>
  static void add(std::deque<Image>& waiting, Image image) {
    constexpr std::size_t kMostWaiting = 4;
    waiting.push_back(std::move(image));
    if (waiting.size() > kMostWaiting) waiting.pop_front();
  }
  template <class Image>
  static void erase_through(std::deque<Image>& waiting, std::size_t index) {
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(index) + 1);
  }

  std::deque<TimedImage<Color>> color_;  // the oldest first
  std::deque<TimedImage<Depth>> depth_;
};

}  // namespace stillmap
