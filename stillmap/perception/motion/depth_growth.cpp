// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/depth_growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "stillmap/core/vector_clones.hpp"

namespace stillmap {
namespace {

constexpr float kAny = std::numeric_limits<float>::infinity();
constexpr float kNobody = -1.0F;

/// Two rows of an image, from where cells of 2x2 pixels begin to the image's border.
struct PixelRows {
  const float *depth0, *depth1;
  const std::uint8_t *ids0, *ids1;
  int size;
};

/// The pixel right of a cell's first one; there is none beyond the border of an image of odd width.
std::size_t right_of(const PixelRows& rows, std::size_t cell) {
  return std::min(2 * cell + 1, static_cast<std::size_t>(rows.size) - 1);
}

float first_known(float a, float b, float c, float d) {
  const float last = c > 0 ? c : std::max(d, 0.0F);
  const float later = b > 0 ? b : last;
  return a > 0 ? a : later;
}

// The following is branch-free, so that it vectorises.

STILLMAP_VECTOR_CLONES
void first_depths(const PixelRows& rows, std::size_t cells, float* __restrict depth) {
  const float *upper = rows.depth0, *lower = rows.depth1;
  for (std::size_t c = 0; c + 1 < cells; ++c) {
    depth[c] = first_known(upper[2 * c], lower[2 * c + 1], upper[2 * c + 1], lower[2 * c]);
  }
  const std::size_t x = 2 * (cells - 1), x1 = right_of(rows, cells - 1);
  depth[cells - 1] = first_known(upper[x], lower[x1], upper[x1], lower[x]);
}

/// Whether one of a cell's pixels has the id.
STILLMAP_VECTOR_CLONES
void find_ids(const PixelRows& rows,
              std::uint8_t id,
              std::size_t cells,
              std::uint8_t* __restrict found) {
  const std::uint8_t *upper = rows.ids0, *lower = rows.ids1;
  for (std::size_t c = 0; c + 1 < cells; ++c) {
    const bool left = (upper[2 * c] == id) | (lower[2 * c] == id);
    const bool right = (upper[2 * c + 1] == id) | (lower[2 * c + 1] == id);
    found[c] = left | right ? 1 : 0;
  }
  const std::size_t x = 2 * (cells - 1), x1 = right_of(rows, cells - 1);
  const bool last = upper[x] == id || upper[x1] == id || lower[x] == id || lower[x1] == id;
  found[cells - 1] = last ? 1 : 0;
}

STILLMAP_VECTOR_CLONES
void find_others(const std::uint8_t* ids, std::size_t cells, std::uint8_t* __restrict found) {
  for (std::size_t c = 0; c < cells; ++c) found[c] = ids[2 * c];
}

struct StillRule {
  float base_m, per_m;
};

/// Marks cells whose depth is the known one.
STILLMAP_VECTOR_CLONES
void find_still(const float* depth,
                const float* known,
                const StillRule& rule,
                std::size_t cells,
                std::uint8_t* __restrict found) {
  const float base = rule.base_m, per = rule.per_m;
  for (std::size_t c = 0; c < cells; ++c) {
    const float tolerance = base + per * known[c] * known[c];
    const bool still = (known[c] > 0) & (std::abs(known[c] - depth[c]) < tolerance);
    found[c] = still ? 1 : found[c];
  }
}

struct MeasuredRow {
  const float* depth;
  const std::uint8_t* ids;
};

/// A row of cells, for the pixels in it.
struct CellRow {
  const float *depth, *reach;
};

/// The mask pixels that belong to the object: all, or those of these depths or without any.
struct OwnRule {
  std::uint8_t id;
  bool all;
  DepthInterval depths;
};

/// Decides which pixels of a row are the object's.
STILLMAP_VECTOR_CLONES
void decide(const MeasuredRow& row,
            const CellRow& cells,
            const OwnRule& own,
            std::size_t size,
            std::uint8_t* __restrict pixels) {
  const float *depth = row.depth, *cell = cells.depth, *reach = cells.reach;
  const std::uint8_t *ids = row.ids, id = own.id;
  const bool all = own.all;
  const float low = own.depths.min_m, high = own.depths.max_m;
  for (std::size_t x = 0; x < size; ++x) {
    const float z = depth[x];
    const bool missing = z <= 0;
    const bool by_mask = (ids[x] == id) & (missing | all | ((z >= low) & (z <= high)));
    const bool near = (std::abs(z - cell[x]) < reach[x]) | (reach[x] == kAny);
    const bool by_cell = (reach[x] >= 0) & (missing | near);
    pixels[x] = by_mask | by_cell ? 1 : 0;
  }
}

/// The depth of every second pixel in every second row: a quarter of the work, and sufficient for
/// the size of objects. A rim of cells without depth saves tests for the border.
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
        cells_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_ + 2)),
        row_depth_(static_cast<std::size_t>(columns_)),
        row_mask_(row_depth_.size()),
        row_other_(row_depth_.size()) {
    order_.reserve(cells_.size());
    for (int row = 0; row < rows_; ++row) fill_row(row);
  }

  /// Numbers the connected parts of the mask and finds those that belong to the object.
  void label_parts() {
    for (int i = 0; i < static_cast<int>(cells_.size()); ++i) {
      if (!at(i).mask || at(i).part != 0 || at(i).depth <= 0) continue;
      parts_.push_back({});
      const std::size_t first = order_.size();
      take(i, static_cast<std::uint32_t>(parts_.size()));
      for (std::size_t next = first; next < order_.size(); ++next) {
        for (const int neighbour : neighbours(order_[next])) {
          if (at(neighbour).mask && is_worth_keeping(order_[next], neighbour)) {
            take(neighbour, at(i).part);
          }
        }
      }
      parts_.back().seeds = order_.size() - first;
    }
    seeds_ = order_.size();
    judge_parts();
  }

  /// Adds the cells connected to the object's parts, a ring of cells at a time.
  void grow() {
    std::size_t begin = 0;
    for (int way = 2; way <= rule_.longest_way_px && begin < order_.size(); way += 2) {
      const std::size_t end = order_.size();
      for (; begin < end; ++begin) {
        const int from = order_[begin];
        const Part& part = parts_[at(from).part - 1];
        if (!part.ours) continue;
        for (const int neighbour : neighbours(from)) {
          if (part.fitting.contains(at(neighbour).depth) && is_worth_keeping(from, neighbour)) {
            take(neighbour, at(from).part);
          }
        }
      }
    }
    for (const int i : order_) ++parts_[at(i).part - 1].cells;
  }

  /// Removes growth from parts that are mostly not mask, and parts of other objects.
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
    PixelPatch patch{area, cv::Mat1b(area.size())};
    std::vector<float> depth(2 * static_cast<std::size_t>(columns_)), reach(depth.size());
    const auto first = static_cast<std::size_t>(area.x - x0_);
    const OwnRule own{static_cast<std::uint8_t>(object_.id), !rule_.drop_outliers, rule_.seeds};
    for (int y = area.y; y < area.y + area.height; ++y) {
      if (y == area.y || (y - y0_) % 2 == 0) spread_cells((y - y0_) / 2, depth, reach);
      decide({object_.depth.mat[y] + area.x, object_.mask.mat[y] + area.x},
             {&depth[first], &reach[first]},
             own,
             static_cast<std::size_t>(area.width),
             patch.pixels[y - area.y]);
    }
    return patch;
  }

 private:
  struct Cell {
    float depth = 0;
    std::uint32_t part = 0;  // number of the part with this cell, from 1
    bool mask = false, visited = false;
    bool rim = true;  // border of the image, or a cell that may not join; never a hole
  };
  struct Part {
    std::size_t seeds = 0;          // cells of the mask
    std::size_t fitting_seeds = 0;  // of the object's depths
    std::size_t cells = 0;          // including grown cells
    DepthInterval fitting{1e9F, 0.0F};
    bool ours = false;
  };

  /// A part belongs to the object if it mostly has the object's depths, or if it is large: an arm
  /// held out, or another person in the same mask.
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
    const PixelRows pixels{object_.depth.mat[y] + x0_,
                           object_.depth.mat[y1] + x0_,
                           object_.mask.mat[y] + x0_,
                           object_.mask.mat[y1] + x0_,
                           object_.depth.mat.cols - x0_};
    const float* known =
        rule_.known_static.empty() ? nullptr : rule_.known_static.mat[y / 2] + x0_ / 2;
    const auto columns = static_cast<std::size_t>(columns_);
    first_depths(pixels, columns, row_depth_.data());
    find_ids(pixels, static_cast<std::uint8_t>(object_.id), columns, row_mask_.data());
    find_others(pixels.ids0, columns, row_other_.data());
    if (known != nullptr) {
      find_still(row_depth_.data(),
                 known,
                 {rule_.static_m, rule_.static_per_m},
                 columns,
                 row_other_.data());
    }
    Cell* cells = &at(index(row, 0));
    for (std::size_t c = 0; c < columns; ++c) {
      const bool mask = row_mask_[c] != 0;
      const bool rim = !mask && row_other_[c] != 0;  // of another object, or excluded
      cells[c] = {rim ? 0.0F : row_depth_[c], 0, mask, false, rim};
    }
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

  [[nodiscard]] bool is_worth_keeping(int from, int to) const {
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

  /// For both pixels of each cell of a row: the cell's depth, and the greatest deviation from it.
  void spread_cells(int row, std::vector<float>& depth, std::vector<float>& reach) const {
    const Cell* cells = &at(index(row, 0));
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns_); ++c) {
      const Cell& cell = cells[c];
      const float far = cell.part == 0 ? kNobody : cell.part == kHole ? kAny : step(cell.depth);
      depth[2 * c] = depth[2 * c + 1] = cell.depth;
      reach[2 * c] = reach[2 * c + 1] = far;
    }
  }

  const ObjectView& object_;
  const GrowthRule& rule_;
  int x0_, y0_, columns_, rows_, stride_;
  std::vector<Cell> cells_;
  std::vector<int> order_;  // joined cells, seeds first
  std::vector<Part> parts_;
  std::vector<float> row_depth_;  // used while cells are filled
  std::vector<std::uint8_t> row_mask_, row_other_;
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
