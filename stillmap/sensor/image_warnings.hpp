// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace stillmap {

/// Counts the images that read_color_file() has read with a warning.
class ImageWarnings {
 public:
  /// Adds the warning of an image; an empty one does not count.
  void add(const std::string& warning) {
    if (!warning.empty() && count_++ == 0) first_ = warning;
  }

  /// The count, with the first warning, in one line; no line without warnings.
  [[nodiscard]] std::vector<std::string> lines() const {
    if (count_ == 0) return {};
    return {fmt::format("{} {} not quite in order, all pixels are there; the first: {}",
                        count_,
                        count_ == 1 ? "image is" : "images are",
                        first_)};
  }

 private:
  std::size_t count_ = 0;
  std::string first_;
};

}  // namespace stillmap
