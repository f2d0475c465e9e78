// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/fast_corners.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/vector_clones.hpp"

namespace stillmap {
namespace {

using Byte = std::uint8_t;
constexpr std::size_t kCircle = 16;

struct Least {
  Byte operator()(Byte a, Byte b) const { return a < b ? a : b; }
};
struct Greatest {
  Byte operator()(Byte a, Byte b) const { return a > b ? a : b; }
};
constexpr Least least;
constexpr Greatest greatest;

/// Calls a function for 0 to N - 1, unrolled, so that the loops around it vectorise.
template <std::size_t N, class Do>
void for_each_index(const Do& act) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (act(I), ...);
  }
  (std::make_index_sequence<N>());
}

/// The greatest of the least values of all arcs of nine; with least and greatest exchanged, the
/// least of the greatest. Arcs that begin at adjacent pixels share eight values.
template <class Inner, class Outer>
[[gnu::always_inline]] inline Byte over_arcs(const std::array<Byte, kCircle>& p,
                                             const Inner& inner,
                                             const Outer& outer) {
  std::array<Byte, 8> two, four, arcs;  // values of runs from each odd pixel
  for_each_index<8>([&](std::size_t i) { two[i] = inner(p[2 * i + 1], p[(2 * i + 2) % kCircle]); });
  for_each_index<8>([&](std::size_t i) { four[i] = inner(two[i], two[(i + 1) % 8]); });
  for_each_index<8>([&](std::size_t i) {
    const Byte eight = inner(four[i], four[(i + 2) % 8]);
    arcs[i] = inner(eight, outer(p[2 * i], p[(2 * i + 9) % kCircle]));
  });
  return outer(outer(outer(arcs[0], arcs[1]), outer(arcs[2], arcs[3])),
               outer(outer(arcs[4], arcs[5]), outer(arcs[6], arcs[7])));
}

/// The scores of a row of pixels. `rows` are the row itself, with three rows above and three below.
/// Branch-free, so that it vectorises.
STILLMAP_VECTOR_CLONES
void score_row(const std::array<const Byte*, 7>& rows, std::ptrdiff_t size, Byte* scores) {
  const Byte *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3];
  const Byte *r4 = rows[4], *r5 = rows[5], *r6 = rows[6];
  for (std::ptrdiff_t x = 0; x < size; ++x) {
    const std::array<Byte, kCircle> p = {r6[x],
                                         r6[x + 1],
                                         r5[x + 2],
                                         r4[x + 3],
                                         r3[x + 3],
                                         r2[x + 3],
                                         r1[x + 2],
                                         r0[x + 1],
                                         r0[x],
                                         r0[x - 1],
                                         r1[x - 2],
                                         r2[x - 3],
                                         r3[x - 3],
                                         r4[x - 3],
                                         r5[x - 2],
                                         r6[x - 1]};
    const Byte v = r3[x];
    const Byte bright = over_arcs(p, least, greatest), dark = over_arcs(p, greatest, least);
    const Byte brighter = static_cast<Byte>(greatest(bright, v) - v);
    const Byte darker = static_cast<Byte>(v - least(dark, v));
    scores[x] = static_cast<Byte>(greatest(greatest(brighter, darker), 1) - 1);
  }
}

/// Keeps the scores of a row that are greater than all eight neighbours. `rows` are the row above,
/// the row and the row below, each with one more value at both ends.
STILLMAP_VECTOR_CLONES
void keep_peaks(const std::array<const Byte*, 3>& rows,
                std::ptrdiff_t size,
                Byte threshold,
                Byte* peaks) {
  const Byte *above = rows[0], *row = rows[1], *below = rows[2];
  for (std::ptrdiff_t x = 0; x < size; ++x) {
    const Byte left = greatest(greatest(above[x - 1], row[x - 1]), below[x - 1]);
    const Byte right = greatest(greatest(above[x + 1], row[x + 1]), below[x + 1]);
    const Byte around = greatest(greatest(left, right), greatest(above[x], below[x]));
    const bool peak = (row[x] > around) & (row[x] >= threshold);
    peaks[x] = peak ? row[x] : Byte{0};
  }
}

/// Calls visit(x) for each value that is not 0. Few are.
template <class Visit>
void for_each_set(const std::vector<Byte>& values, const Visit& visit) {
  constexpr std::size_t kEight = 8;
  for (std::size_t x = 0; x < values.size();) {
    std::uint64_t eight = 1;
    if (x + kEight <= values.size()) std::memcpy(&eight, &values[x], kEight);
    if (eight == 0) {
      x += kEight;
      continue;
    }
    const std::size_t end = std::min(x + kEight, values.size());
    for (; x < end; ++x) {
      if (values[x] != 0) visit(x);
    }
  }
}

}  // namespace

cv::Mat1b corner_scores(const cv::Mat1b& image) {
  constexpr int kRim = kCornerCircleRadiusPx;
  cv::Mat1b scores(image.size(), std::uint8_t{0});
  if (image.cols <= 2 * kRim) return scores;
  const int width = image.cols - 2 * kRim;
  // The last vector overlaps the one before: a scalar remainder would take as long as all vectors.
  constexpr int kVector = 32;
  const int whole = width < kVector ? width : width - width % kVector;
  for (int y = kRim; y < image.rows - kRim; ++y) {
    const auto score_from = [&](int x, int size) {
      std::array<const Byte*, 7> rows;
      for (int k = 0; k < 7; ++k) rows[static_cast<std::size_t>(k)] = image[y - kRim + k] + x;
      score_row(rows, size, scores[y] + x);
    };
    score_from(kRim, whole);
    if (whole < width) score_from(kRim + width - kVector, kVector);
  }
  return scores;
}

std::vector<cv::KeyPoint> local_maxima(const cv::Mat1b& scores,
                                       const cv::Rect& area,
                                       int threshold) {
  STILLMAP_CHECK(area.x >= 0 && area.width >= 0 && area.x + area.width <= scores.cols);
  STILLMAP_CHECK(area.y >= 0 && area.height >= 0 && area.y + area.height <= scores.rows);
  STILLMAP_CHECK(threshold > 0 && threshold < 256);
  constexpr float kDiameter = 2 * kCornerCircleRadiusPx + 1;
  std::vector<cv::KeyPoint> maxima;
  const auto width = static_cast<std::size_t>(area.width);
  std::vector<Byte> above(width + 2, 0), row(width + 2, 0), below(width + 2, 0), peaks(width);
  const auto load = [&](int y, std::vector<Byte>& target) {
    std::copy_n(scores[area.y + y] + area.x, width, target.begin() + 1);
  };
  if (area.height > 0) load(0, below);
  for (int y = 0; y < area.height; ++y) {
    std::swap(above, row);
    std::swap(row, below);
    y + 1 < area.height ? load(y + 1, below) : below.assign(width + 2, 0);
    keep_peaks(
        {&above[1], &row[1], &below[1]}, area.width, static_cast<Byte>(threshold), peaks.data());
    for_each_set(peaks, [&](std::size_t x) {
      maxima.emplace_back(static_cast<float>(area.x + static_cast<int>(x)),
                          static_cast<float>(area.y + y),
                          kDiameter,
                          -1.0F,
                          static_cast<float>(peaks[x]));
    });
  }
  return maxima;
}

}  // namespace stillmap
