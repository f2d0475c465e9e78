// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/patch_blur.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/vector_clones.hpp"

namespace stillmap {
namespace {

using Byte = std::uint8_t;
constexpr int kReach = 3;

// Weights in 1/256 from the rim to the middle; their sum is 256. All sums are whole numbers below
// 2^24 and exact in floating point, too, which vectorises better.
constexpr unsigned kRim = 18, kOuter = 34, kInner = 48, kMiddle = 56;

/// The weighted sums of seven rows.
STILLMAP_VECTOR_CLONES
void sum_rows(const std::array<const Byte*, 7>& rows, std::ptrdiff_t size, float* sums) {
  const Byte *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3];
  const Byte *r4 = rows[4], *r5 = rows[5], *r6 = rows[6];
  for (std::ptrdiff_t x = 0; x < size; ++x) {
    std::uint16_t sum = static_cast<std::uint16_t>(kMiddle * r3[x]);
    sum = static_cast<std::uint16_t>(sum + kRim * (r0[x] + r6[x]));
    sum = static_cast<std::uint16_t>(sum + kOuter * (r1[x] + r5[x]));
    sum = static_cast<std::uint16_t>(sum + kInner * (r2[x] + r4[x]));
    sums[x] = static_cast<float>(sum);
  }
}

/// The weighted sums of seven adjacent sums, rounded to grey levels. There are three more sums at
/// both ends.
STILLMAP_VECTOR_CLONES
void sum_columns(const float* sums, std::ptrdiff_t size, Byte* __restrict blurred) {
  constexpr float kHalf = 32768.0F;
  for (std::ptrdiff_t x = 0; x < size; ++x) {
    const float* s = sums + x;
    const float sum =
        static_cast<float>(kRim) * (s[-3] + s[3]) + static_cast<float>(kOuter) * (s[-2] + s[2]) +
        static_cast<float>(kInner) * (s[-1] + s[1]) + static_cast<float>(kMiddle) * s[0];
    blurred[x] = static_cast<Byte>(static_cast<std::int32_t>(sum + kHalf) >> 16);
  }
}

/// An index mirrored at the first and the last element, which are not doubled.
int mirrored(int i, int count) {
  const int before = std::abs(i);
  return before < count ? before : 2 * (count - 1) - before;
}

}  // namespace

cv::Mat1b blurred_for_descriptors(const cv::Mat1b& image) {
  STILLMAP_CHECK(image.rows > kReach && image.cols > kReach);
  cv::Mat1b blurred(image.size());
  std::vector<float> sums(static_cast<std::size_t>(image.cols) + 2 * kReach);
  float* first = sums.data() + kReach;
  for (int y = 0; y < image.rows; ++y) {
    std::array<const Byte*, 7> rows;
    for (int k = 0; k < 7; ++k) {
      rows[static_cast<std::size_t>(k)] = image[mirrored(y + k - kReach, image.rows)];
    }
    sum_rows(rows, image.cols, first);
    for (int k = 1; k <= kReach; ++k) {
      first[-k] = first[k];
      first[image.cols - 1 + k] = first[image.cols - 1 - k];
    }
    sum_columns(first, image.cols, blurred[y]);
  }
  return blurred;
}

}  // namespace stillmap
