// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr float kBinsPerMetre = 1000.0F;
constexpr int kBins = 16384;
constexpr float kFarthest = 16.0F;

/// A histogram of depths in millimetres. It gives medians without sorting.
class DepthHistogram {
 public:
  void add(float depth) {
    ++bins_[static_cast<std::size_t>(depth * kBinsPerMetre)];
    ++count_;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] int median_bin() const {
    std::size_t below = 0;
    int bin = 0;
    while (below + bins_[static_cast<std::size_t>(bin)] <= (count_ - 1) / 2) {
      below += bins_[static_cast<std::size_t>(bin++)];
    }
    return bin;
  }

  /// The least distance from a bin, in bins, within which more than half of all depths lie.
  [[nodiscard]] int median_distance(int bin) const {
    std::size_t within = at(bin);
    int distance = 0;
    while (within <= (count_ - 1) / 2) {
      ++distance;
      within += at(bin - distance) + at(bin + distance);
    }
    return distance;
  }

 private:
  [[nodiscard]] std::size_t at(int bin) const {
    return bin >= 0 && bin < kBins ? bins_[static_cast<std::size_t>(bin)] : 0;
  }

  std::vector<std::uint32_t> bins_ = std::vector<std::uint32_t>(kBins, 0);
  std::size_t count_ = 0;
};

bool measured(float depth) {
  return depth > 0 && depth < kFarthest;
}

/// Calls visit(depth) for every pixel of an id with depth.
template <class Visit>
void for_depths(const DepthImage& depth,
                const ObjectMask& mask,
                int id,
                const cv::Rect& area,
                const Visit& visit) {
  for (int row = area.y; row < area.y + area.height; ++row) {
    const float* z = depth.mat[row];
    const std::uint8_t* ids = mask.mat[row];
    for (int x = area.x; x < area.x + area.width; ++x) {
      if (ids[x] == id && measured(z[x])) visit(z[x]);
    }
  }
}

}  // namespace

MaskAreas mask_areas(const ObjectMask& mask) {
  struct Bounds {
    int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1;
    std::size_t pixels = 0;
  };
  std::array<Bounds, 256> bounds;
  const cv::Mat1b& ids = mask.mat;
  const auto add_run = [&bounds](std::uint8_t id, int row, int begin, int end) {
    Bounds& b = bounds[id];
    b.x0 = std::min(b.x0, begin);
    b.x1 = std::max(b.x1, end);
    b.y0 = std::min(b.y0, row);
    b.y1 = row + 1;
    b.pixels += static_cast<std::size_t>(end - begin);
  };
  for (int row = 0; row < ids.rows; ++row) {
    const std::uint8_t* line = ids[row];
    for (int x = 0; x < ids.cols;) {
      const std::uint8_t id = line[x];
      const int begin = x;
      if (id == 0) {  // most pixels belong to no object: skips eight at a time
        std::uint64_t eight = 0;
        while (x + 8 <= ids.cols && (std::memcpy(&eight, line + x, 8), eight == 0)) x += 8;
      }
      while (x < ids.cols && line[x] == id) ++x;
      if (id != 0) add_run(id, row, begin, x);
    }
  }
  MaskAreas areas;
  for (std::size_t id = 1; id < areas.size(); ++id) {
    const Bounds& b = bounds[id];
    if (b.pixels > 0) areas[id] = {cv::Rect(b.x0, b.y0, b.x1 - b.x0, b.y1 - b.y0), b.pixels};
  }
  return areas;
}

ObjectDepths object_depths(const DepthImage& depth,
                           const ObjectMask& mask,
                           int id,
                           const MaskArea& area,
                           const OutlierRule& rule) {
  if (area.pixels == 0) return {};
  STILLMAP_CHECK(depth.mat.size() == mask.mat.size());
  DepthHistogram histogram;
  for_depths(depth, mask, id, area.bounds, [&](float z) { histogram.add(z); });
  if (histogram.count() == 0) return {};
  const int middle = histogram.median_bin();
  ObjectDepths depths;
  depths.measured = histogram.count();
  depths.median_m = (static_cast<float>(middle) + 0.5F) / kBinsPerMetre;
  depths.mad_m = static_cast<float>(histogram.median_distance(middle)) / kBinsPerMetre;
  // One bin at least, so that depths within a single bin are not outliers.
  const double reach = std::max({rule.mad_factor * 1.4826 * static_cast<double>(depths.mad_m),
                                 rule.min_reach_m,
                                 1.0 / static_cast<double>(kBinsPerMetre)});
  const auto low = static_cast<float>(static_cast<double>(depths.median_m) - reach);
  const auto high = static_cast<float>(static_cast<double>(depths.median_m) + reach);
  DepthInterval interval{kFarthest, 0.0F};  // not empty: the median is always inside
  for_depths(depth, mask, id, area.bounds, [&](float z) {
    if (z < low || z > high) return;
    interval.min_m = std::min(interval.min_m, z);
    interval.max_m = std::max(interval.max_m, z);
  });
  depths.interval = interval;
  return depths;
}

}  // namespace stillmap
