// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/depth_islands.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace stillmap {
namespace {

/// Consecutive pixels of a row with depth: columns begin to end - 1.
struct Run {
  int row, begin, end;
  std::uint32_t patch;   // index of a run of the same patch; of itself for the root of the patch
  std::uint32_t pixels;  // of the whole patch, at its root
};

/// The runs of an image, joined to patches (union-find).
class Patches {
 public:
  explicit Patches(const cv::Mat1f& depth) {
    std::size_t above = 0;  // first run of the row above
    for (int row = 0; row < depth.rows; ++row) {
      const std::size_t first = runs_.size();
      append_runs(depth, row);
      join(above, first);
      above = first;
    }
  }

  [[nodiscard]] std::size_t size() const { return runs_.size(); }
  [[nodiscard]] const Run& run(std::size_t i) const { return runs_[i]; }
  /// The number of pixels of the patch of run i.
  [[nodiscard]] std::uint32_t pixels(std::size_t i) {
    return runs_[find(static_cast<std::uint32_t>(i))].pixels;
  }

 private:
  void append_runs(const cv::Mat1f& depth, int row) {
    const float* z = depth[row];
    for (int x = 0; x < depth.cols;) {
      if (!(z[x] > 0)) {
        ++x;
        continue;
      }
      const int begin = x;
      while (x < depth.cols && z[x] > 0) ++x;
      const auto index = static_cast<std::uint32_t>(runs_.size());
      runs_.push_back({row, begin, x, index, static_cast<std::uint32_t>(x - begin)});
    }
  }

  /// Joins the runs of two rows that share a column: runs `above` to `first` - 1, and `first` to
  /// the end.
  void join(std::size_t above, std::size_t first) {
    std::size_t a = above, b = first;
    while (a < first && b < runs_.size()) {
      if (runs_[a].begin < runs_[b].end && runs_[b].begin < runs_[a].end) {
        unite(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
      }
      runs_[a].end < runs_[b].end ? ++a : ++b;
    }
  }

  std::uint32_t find(std::uint32_t i) {
    while (runs_[i].patch != i) i = runs_[i].patch = runs_[runs_[i].patch].patch;
    return i;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    if (runs_[a].pixels < runs_[b].pixels) std::swap(a, b);  // the larger one stays the root
    runs_[b].patch = a;
    runs_[a].pixels += runs_[b].pixels;
  }

  std::vector<Run> runs_;
};

}  // namespace

cv::Mat1f without_islands(const cv::Mat1f& depth, double min_pixels) {
  cv::Mat1f kept(depth.size(), 0.0F);
  Patches patches(depth);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches.pixels(i) < min_pixels) continue;
    const Run& run = patches.run(i);
    const float* from = depth[run.row];
    std::copy(from + run.begin, from + run.end, kept[run.row] + run.begin);
  }
  return kept;
}

}  // namespace stillmap
