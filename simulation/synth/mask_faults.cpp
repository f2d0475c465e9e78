// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/mask_faults.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {
namespace {

constexpr int kWavePx = 16;  // between the nodes of the waves along an edge

// Smooth noise in [-1, 1]: hashed values at the nodes of a lattice, linear in between.
cv::Mat1f slow_waves(cv::Size size, std::uint64_t key) {
  cv::Mat1f nodes(size.height / kWavePx + 2, size.width / kWavePx + 2);
  for (float& node : nodes) node = 2.F * hash_uniform(key++) - 1.F;
  cv::Mat1f waves(size);
  for (int v = 0; v < size.height; ++v) {
    const float y = static_cast<float>(v % kWavePx) / kWavePx;
    const float* upper = nodes[v / kWavePx];
    const float* lower = nodes[v / kWavePx + 1];
    for (int u = 0; u < size.width; ++u) {
      const float x = static_cast<float>(u % kWavePx) / kWavePx;
      const int i = u / kWavePx;
      const float left = upper[i] + y * (lower[i] - upper[i]);
      const float right = upper[i + 1] + y * (lower[i + 1] - upper[i + 1]);
      waves(v, u) = left + x * (right - left);
    }
  }
  return waves;
}

int part_of(int length, double share) {
  return std::max(1, static_cast<int>(std::lround(share * length)));
}

}  // namespace

cv::Mat1b with_wandering_edge(const cv::Mat1b& mask,
                              double loss_px,
                              double wander_px,
                              std::uint64_t key) {
  cv::Mat1b moved(mask.size(), std::uint8_t{0});
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty()) return moved;
  const int reach = static_cast<int>(std::ceil(std::max(wander_px - loss_px, 0.0))) + 2;
  const cv::Rect room =
      cv::Rect(box.x - reach, box.y - reach, box.width + 2 * reach, box.height + 2 * reach) &
      cv::Rect(cv::Point(0, 0), mask.size());
  const cv::Mat1b before = mask(room);
  cv::Mat1b after = moved(room);
  cv::Mat1f inside, outside;
  cv::distanceTransform(before, inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(~before, outside, cv::DIST_L2, cv::DIST_MASK_5);
  const cv::Mat1f waves = slow_waves(room.size(), key);
  const float loss = static_cast<float>(loss_px), wander = static_cast<float>(wander_px);
  for (int v = 0; v < room.height; ++v) {
    for (int u = 0; u < room.width; ++u) {
      // The edge runs half a pixel from the centres on either side of it.
      const float depth = before(v, u) != 0 ? inside(v, u) - 0.5F : 0.5F - outside(v, u);
      after(v, u) = depth > loss + wander * waves(v, u) ? 255 : 0;
    }
  }
  return moved;
}

cv::Mat1b with_end_cut_off(const cv::Mat1b& mask, std::uint64_t key) {
  cv::Mat1b cut = mask.clone();
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty()) return cut;
  HashStream random(key);
  const int end = random.below(9);  // 0-3 a leg, 4-7 an arm, 8 the head
  const bool left = end % 2 == 0;
  cv::Rect block = box;
  if (end < 4) {
    block.width = part_of(box.width, random.uniform(0.4, 0.6));
    block.height = part_of(box.height, random.uniform(0.15, 0.33));
    block.y = box.y + box.height - block.height;
  } else if (end < 8) {
    block.width = part_of(box.width, random.uniform(0.15, 0.33));
    block.height = part_of(box.height, random.uniform(0.3, 0.5));
    block.y = box.y + part_of(box.height, random.uniform(0.15, 0.3));
  } else {
    block.height = part_of(box.height, random.uniform(0.1, 0.2));
  }
  if (end < 8 && !left) block.x = box.x + box.width - block.width;
  cut(block & box).setTo(0);
  return cut;
}

cv::Mat1b with_leak(const cv::Mat1b& mask, std::uint64_t key) {
  cv::Mat1b grown = mask.clone();
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty()) return grown;
  HashStream random(key);
  // A row's first or last pixel is on the edge.
  const int v = box.y + random.below(box.height);
  const bool left = random.below(2) == 0;
  int u = left ? box.x : box.x + box.width - 1;
  while (u >= box.x && u < box.x + box.width && mask(v, u) == 0) u += left ? 1 : -1;
  const double radius =
      0.5 * std::sqrt(static_cast<double>(box.area()) * random.uniform(0.04, 0.09));
  const double stretch = random.uniform(0.7, 1.4);
  const cv::Size axes(part_of(1, radius * stretch), part_of(1, radius / stretch));
  const double turn_deg = random.uniform(0.0, 180.0);
  cv::ellipse(grown, cv::Point(u, v), axes, turn_deg, 0.0, 360.0, cv::Scalar(255), cv::FILLED);
  return grown;
}

}  // namespace stillmap
