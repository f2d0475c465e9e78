// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dynamics/depth_growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stillmap {
namespace {

/// The depth of every second pixel in every second row, which is a quarter of the work and as good,
/// as objects are larger than that. A rim of cells without depth saves asking for the border.
class GrowthGrid {
 public:
  GrowthGrid(const ObjectView& object, const cv::Rect& area, const GrowthRule& rule)
      : object_(object),
        rule_(rule),
        x0_(area.x & ~1),
        y0_(area.y & ~1),
        columns_((area.x + area.width - x0_ + 1) / 2),
        rows_((area.y + area.height - y0_ + 1) / 2),
        stride_(columns_ + 2),
        cells_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_ + 2)) {
    order_.reserve(cells_.size());
    for (int row = 0; row < rows_; ++row) fill_row(row);
  }

  /// Numbers the parts of the mask that hang together, and finds those that are the object's.
  void label_parts() {
    for (int i = 0; i < static_cast<int>(cells_.size()); ++i) {
      if (!at(i).mask || at(i).part != 0 || at(i).depth <= 0) continue;
      parts_.push_back({});
      const std::size_t first = order_.size();
      take(i, static_cast<std::uint32_t>(parts_.size()));
      for (std::size_t next = first; next < order_.size(); ++next) {
        for (const int neighbour : neighbours(order_[next])) {
          if (at(neighbour).mask && joins(order_[next], neighbour)) {
            take(neighbour, at(i).part);
          }
        }
      }
      parts_.back().seeds = order_.size() - first;
    }
    seeds_ = order_.size();
    judge_parts();
  }

  /// Adds what hangs together with the object's parts, a ring of cells at a time.
  void grow() {
    std::size_t begin = 0;
    for (int way = 2; way <= rule_.longest_way_px && begin < order_.size(); way += 2) {
      const std::size_t end = order_.size();
      for (; begin < end; ++begin) {
        const int from = order_[begin];
        const Part& part = parts_[at(from).part - 1];
        if (!part.ours) continue;
        for (const int neighbour : neighbours(from)) {
          if (part.fitting.contains(at(neighbour).depth) && joins(from, neighbour)) {
            take(neighbour, at(from).part);
          }
        }
      }
    }
    for (const int i : order_) ++parts_[at(i).part - 1].cells;
  }

  /// Takes back what grew from parts that are mostly not mask, and parts of something else.
  void prune() {
    for (std::size_t k = 0; k < order_.size(); ++k) {
      Cell& cell = at(order_[k]);
      const Part& part = parts_[cell.part - 1];
      const double enough = rule_.min_mask_share * static_cast<double>(part.cells);
      const bool grown = k >= seeds_;
      if (!part.ours || (grown && static_cast<double>(part.seeds) < enough)) cell.part = 0;
    }
  }

  /// Gives holes without depth to the object that most of their rim belongs to.
  void fill_holes() {
    std::vector<int> hole;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const int first = index(row, column);
        if (at(first).depth > 0 || at(first).rim || at(first).visited) continue;
        const double share = collect_hole(first, hole);
        if (share < kHoleRim) continue;
        for (const int i : hole) at(i).part = kHole;
      }
    }
  }

  [[nodiscard]] PixelPatch pixels(const cv::Rect& area) const {
    PixelPatch patch{area, cv::Mat1b(area.size(), std::uint8_t{0})};
    for (int row = 0; row < rows_; ++row) {
      const Cell* cells = &at(index(row, 0));
      for (int column = 0; column < columns_; ++column) {
        if (cells[column].part != 0 || cells[column].mask) copy_cell(row, column, patch);
      }
    }
    return patch;
  }

 private:
  struct Cell {
    float depth = 0;
    std::uint32_t part = 0;  // that has it, from 1
    bool mask = false, visited = false;
    bool rim = true;  // of the image or of what may not join: neither joins nor is a hole
  };
  struct Part {
    std::size_t seeds = 0;          // cells of the mask
    std::size_t fitting_seeds = 0;  // of the object's depths
    std::size_t cells = 0;          // with what has grown
    DepthInterval fitting{1e9F, 0.0F};
    bool ours = false;
  };

  /// The object's are the parts that mostly have its depths, and large ones: an arm held out, or
  /// another person in the same mask.
  void judge_parts() {
    for (const int i : order_) {
      Part& part = parts_[at(i).part - 1];
      const float z = at(i).depth;
      part.fitting_seeds += rule_.seeds.contains(z) ? 1 : 0;
      part.fitting.min_m = std::min(part.fitting.min_m, z - rule_.margin_m);
      part.fitting.max_m = std::max(part.fitting.max_m, z + rule_.margin_m);
    }
    for (Part& part : parts_) {
      const double large = rule_.large_part * static_cast<double>(seeds_);
      part.ours = 2 * part.fitting_seeds > part.seeds || static_cast<double>(part.seeds) > large;
    }
  }

  static constexpr std::uint32_t kHole = 0xFFFFFFFF;
  static constexpr double kHoleRim = 0.6;

  void fill_row(int row) {
    const int y = y0_ + 2 * row;
    const int y1 = std::min(y + 1, object_.depth.mat.rows - 1);
    const int last = object_.depth.mat.cols - 1;
    const float *upper = object_.depth.mat[y], *lower = object_.depth.mat[y1];
    const std::uint8_t *ids = object_.mask.mat[y], *ids1 = object_.mask.mat[y1];
    const float* known = rule_.known_static.empty() ? nullptr : rule_.known_static[y / 2];
    const int id = object_.id;
    for (int column = 0; column < columns_; ++column) {
      const int x = x0_ + 2 * column, x1 = std::min(x + 1, last);
      Cell& cell = at(index(row, column));
      cell.rim = false;
      cell.depth = first_known(upper[x], lower[x1], upper[x1], lower[x]);
      cell.mask = ids[x] == id || ids[x1] == id || ids1[x] == id || ids1[x1] == id;
      if (cell.mask) continue;
      const bool still = known != nullptr && stands_still(cell.depth, known[x / 2]);
      if (ids[x] != 0 || still) {  // somebody else's, or nobody's
        cell.depth = 0;
        cell.rim = true;
      }
    }
  }

  [[nodiscard]] static float first_known(float a, float b, float c, float d) {
    if (a > 0) return a;
    if (b > 0) return b;
    return c > 0 ? c : std::max(d, 0.0F);
  }

  [[nodiscard]] bool stands_still(float depth, float known) const {
    const float tolerance = rule_.static_m + rule_.static_per_m * known * known;
    return known > 0 && std::abs(known - depth) < tolerance;
  }

  [[nodiscard]] int index(int row, int column) const { return (row + 1) * stride_ + column + 1; }
  [[nodiscard]] Cell& at(int i) { return cells_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Cell& at(int i) const { return cells_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::array<int, 4> neighbours(int i) const {
    return {i - stride_, i - 1, i + 1, i + stride_};
  }

  [[nodiscard]] float step(float depth) const {
    return rule_.step_m + rule_.step_per_m * depth * depth;
  }

  [[nodiscard]] bool joins(int from, int to) const {
    const Cell& next = at(to);
    return next.part == 0 && next.depth > 0 &&
           std::abs(next.depth - at(from).depth) < step(next.depth);
  }

  void take(int i, std::uint32_t part) {
    at(i).part = part;
    order_.push_back(i);
  }

  /// The cells without depth around one; gives the share of their rim that is the object's.
  double collect_hole(int first, std::vector<int>& hole) {
    hole.assign(1, first);
    at(first).visited = true;
    std::size_t ours = 0, rim = 0;
    for (std::size_t next = 0; next < hole.size(); ++next) {
      for (const int neighbour : neighbours(hole[next])) {
        Cell& cell = at(neighbour);
        if (cell.depth > 0 || cell.rim) {
          ++rim;
          ours += cell.part != 0 ? 1 : 0;
        } else if (!cell.visited) {
          cell.visited = true;
          hole.push_back(neighbour);
        }
      }
    }
    return rim == 0 ? 0.0 : static_cast<double>(ours) / static_cast<double>(rim);
  }

  /// Decides on each of the cell's four pixels.
  void copy_cell(int row, int column, PixelPatch& patch) const {
    const Cell& cell = at(index(row, column));
    const int left = std::max(x0_ + 2 * column, patch.area.x);
    const int right = std::min(x0_ + 2 * column + 2, patch.area.x + patch.area.width);
    const int top = std::max(y0_ + 2 * row, patch.area.y);
    const int bottom = std::min(y0_ + 2 * row + 2, patch.area.y + patch.area.height);
    for (int y = top; y < bottom; ++y) {
      const float* depth = object_.depth.mat[y];
      const std::uint8_t* ids = object_.mask.mat[y];
      std::uint8_t* pixels = patch.pixels[y - patch.area.y] - patch.area.x;
      for (int x = left; x < right; ++x) {
        pixels[x] = belongs(cell, depth[x], ids[x] == object_.id) ? 1 : 0;
      }
    }
  }

  [[nodiscard]] bool belongs(const Cell& cell, float depth, bool mask) const {
    if (mask && (depth <= 0 || !rule_.drop_outliers || rule_.seeds.contains(depth))) return true;
    if (cell.part == 0) return false;
    return cell.part == kHole || depth <= 0 || std::abs(depth - cell.depth) < step(cell.depth);
  }

  const ObjectView& object_;
  const GrowthRule& rule_;
  int x0_, y0_, columns_, rows_, stride_;
  std::vector<Cell> cells_;
  std::vector<int> order_;  // cells taken, seeds first
  std::vector<Part> parts_;
  std::size_t seeds_ = 0;
};

}  // namespace

PixelPatch grow_in_depth(const ObjectView& object, const cv::Rect& area, const GrowthRule& rule) {
  GrowthGrid grid(object, area, rule);
  grid.label_parts();
  grid.grow();
  grid.prune();
  grid.fill_holes();
  return grid.pixels(area);
}

}  // namespace stillmap
