// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/box_mask.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <queue>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/objects/boxes.hpp"
#include "stillmap/perception/objects/object_depth.hpp"

namespace stillmap {
namespace {

constexpr int kLeastSide_px = 16;     // of a box
constexpr int kMostCells = 96;        // along the longer side of a box
constexpr double kMargin = 0.08;      // around a box, as a share of its side
constexpr float kNearest_m = 0.2F;    // depth at which the first layer begins
constexpr double kLayerWidth = 0.04;  // of a class of depths, as a share of the depth
constexpr std::size_t kLayers = 110;  // up to 15 m
constexpr double kWorthwhile = 0.5;   // least size of a nearer layer, as a share of the strongest
constexpr float kThickness_m = 0.7F;  // greatest extent of an object from its layer
constexpr float kStepWay = 12;        // path length of a depth step beyond noise, in cells
constexpr double kRoughReach = 0.05;  // of a rough mask around its box, as a share of its side
constexpr float kDoubtWay = 3;  // path length of a cell that a rough mask gives to the other side
constexpr double kLeastMeasured = 0.2;  // share of a rough mask with depth, else it stays

enum class Side : std::uint8_t { kUndecided, kObject, kOther };

template <class Values>
[[nodiscard]] auto& at(Values& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

/// The box and its surroundings in cells of several pixels, each with the depth of its middle.
class CellGrid {
 public:
  /// `rough_id` is the object's id in `mask`; 0 if only its box is known.
  CellGrid(const DepthImage& depth, const ObjectMask& mask, const PixelBox& box, int rough_id)
      : box_(box), is_rough_(rough_id != 0) {
    const double longer = std::max(box.width(), box.height());
    stride_ = std::max(2, static_cast<int>(std::ceil(longer / kMostCells)));
    const double x = std::max<double>(2 * stride_, kMargin * box.width());
    const double y = std::max<double>(2 * stride_, kMargin * box.height());
    area_ = pixels_of({box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y}, depth.mat.size());
    columns_ = area_.width / stride_;
    rows_ = area_.height / stride_;
    depth_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    side_.assign(depth_.size(), Side::kUndecided);
    own_.assign(depth_.size(), 0);
    for (int i = 0; i < size(); ++i) {
      const cv::Point p = pixel(i);
      const int id = mask.mat.empty() ? 0 : mask.mat(p);
      const bool taken = id != 0 && id != rough_id;
      at(own_, i) = id != 0 && id == rough_id ? 1 : 0;
      const float z = depth.mat(p);
      at(depth_, i) = std::isfinite(z) && z > 0 && !taken ? z : 0.0F;
    }
  }

  /// The strongest layer in the middle of the box, or a nearer one that is nearly as strong.
  [[nodiscard]] std::optional<float> layer(std::optional<float> expected_m) const {
    std::array<double, kLayers> raw{}, smooth{};
    for (int i = 0; i < size(); ++i) {
      const float z = at(depth_, i);
      if (z > kNearest_m) raw[layer_of(z)] += weight(i);
    }
    for (std::size_t k = 1; k + 1 < kLayers; ++k) smooth[k] = raw[k - 1] + raw[k] + raw[k + 1];
    const double strongest = *std::ranges::max_element(smooth);
    if (strongest <= 0) return std::nullopt;
    std::optional<float> best;
    for (std::size_t k = 1; k + 1 < kLayers; ++k) {
      const bool peak = smooth[k] >= smooth[k - 1] && smooth[k] > smooth[k + 1];
      if (!peak || smooth[k] < kWorthwhile * strongest) continue;
      const float z = kNearest_m * std::exp(static_cast<float>((k + 0.5) * kLayerWidth));
      if (!best || (expected_m && std::abs(z - *expected_m) < std::abs(*best - *expected_m))) {
        best = z;
      }
    }
    return best;
  }

  /// Decides the side of every cell with depth.
  void divide(float layer_m) {
    divide_by_paths(layer_m);
    // A leg behind the other one is a part of its own. A missed part does more harm than a false
    // one: only what is far from the layer leaves a rough mask.
    for (int i = 0; i < size(); ++i) {
      const bool near = at(depth_, i) > 0 && std::abs(at(depth_, i) - layer_m) < kThickness_m;
      if (at(own_, i) != 0 && near) at(side_, i) = Side::kObject;
    }
  }

  /// The share of the rough mask's cells that have depth.
  [[nodiscard]] double measured_share() const {
    int own = 0, measured = 0;
    for (int i = 0; i < size(); ++i) {
      own += at(own_, i);
      measured += at(own_, i) != 0 && at(depth_, i) > 0 ? 1 : 0;
    }
    return own == 0 ? 0 : static_cast<double>(measured) / own;
  }

  [[nodiscard]] bool is_object(int i) const { return at(side_, i) == Side::kObject; }
  [[nodiscard]] int size() const { return columns_ * rows_; }
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] cv::Rect cell(int i) const {
    return cv::Rect(
        area_.x + i % columns_ * stride_, area_.y + i / columns_ * stride_, stride_, stride_);
  }
  [[nodiscard]] float depth(int i) const { return at(depth_, i); }

 private:
  void divide_by_paths(float layer_m) {
    mark_certain(layer_m);
    claim_enclosed_parts(layer_m);
    std::vector<float> way(side_.size(), std::numeric_limits<float>::infinity());
    using Entry = std::pair<float, int>;  // cost and cell number, which breaks ties
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
    for (int i = 0; i < size(); ++i) {
      if (at(side_, i) == Side::kUndecided || at(depth_, i) <= 0) continue;
      at(way, i) = 0;
      next.emplace(0.0F, i);
    }
    while (!next.empty()) {
      const float length = next.top().first;
      const int i = next.top().second;
      next.pop();
      if (length > at(way, i)) continue;
      visit_neighbours(i, [&](int neighbour) {
        const float z = at(depth_, neighbour);
        if (z <= 0) return;
        const float steps = std::max(0.0F, std::abs(z - at(depth_, i)) / noise(z) - 1);
        const float longer = length + 1 + kStepWay * std::min(steps, 10.0F) + doubt(i, neighbour);
        if (longer >= at(way, neighbour)) return;
        at(way, neighbour) = longer;
        at(side_, neighbour) = at(side_, i);
        next.emplace(longer, neighbour);
      });
    }
  }

  [[nodiscard]] cv::Point pixel(int i) const {
    return cell(i).tl() + cv::Point(stride_ / 2, stride_ / 2);
  }
  [[nodiscard]] static std::size_t layer_of(float z) {
    const double k = std::log(static_cast<double>(z / kNearest_m)) / kLayerWidth;
    return std::min(kLayers - 1, static_cast<std::size_t>(k));
  }
  /// 0 in the middle of the box, 1 at the middle of its sides.
  [[nodiscard]] double off_middle(int i) const {
    const cv::Point p = pixel(i);
    const double x = (p.x - (box_.x0 + box_.x1) / 2) / (box_.width() / 2);
    const double y = (p.y - (box_.y0 + box_.y1) / 2) / (box_.height() / 2);
    return std::hypot(x, y);
  }
  [[nodiscard]] double weight(int i) const {
    if (is_rough_) return at(own_, i);
    const double off = off_middle(i);
    return off < 1 ? std::exp(-2 * off * off) : 0;
  }
  [[nodiscard]] bool in_box(int i) const {
    const cv::Point p = pixel(i);
    return p.x >= box_.x0 && p.x < box_.x1 && p.y >= box_.y0 && p.y < box_.y1;
  }

  /// The path length that a rough mask adds to a step of the side of `from`.
  [[nodiscard]] float doubt(int from, int to) const {
    const bool as_mask = (at(side_, from) == Side::kObject) == (at(own_, to) != 0);
    return is_rough_ && !as_mask ? kDoubtWay : 0.0F;
  }
  /// Whether a cell at the object's layer certainly belongs to it.
  [[nodiscard]] bool is_core(int i) const {
    return is_rough_ ? at(own_, i) != 0 : off_middle(i) < 0.6;
  }

  void mark_certain(float layer_m) {
    for (int i = 0; i < size(); ++i) {
      const float z = at(depth_, i);
      if (z <= 0) continue;
      const float from_layer = std::abs(z - layer_m);
      if (!in_box(i) || from_layer > kThickness_m) at(side_, i) = Side::kOther;
      if (is_core(i) && from_layer < 2 * static_cast<float>(kLayerWidth) * layer_m) {
        at(side_, i) = Side::kObject;
      }
    }
  }

  [[nodiscard]] static float noise(float z) { return 0.01F + 0.003F * z * z; }

  /// Adds parts that end inside the box, as floors and walls do not: a seat below an arm, a leg.
  void claim_enclosed_parts(float layer_m) {
    std::vector<std::uint8_t> seen(side_.size(), 0);
    std::vector<int> part;
    for (int first = 0; first < size(); ++first) {
      if (at(depth_, first) <= 0 || at(seen, first) != 0) continue;
      bool enclosed = true;
      part.assign(1, first);
      at(seen, first) = 1;
      for (std::size_t next = 0; next < part.size(); ++next) {
        const int i = part[next];
        enclosed = enclosed && in_box(i) && std::abs(at(depth_, i) - layer_m) < kThickness_m;
        visit_neighbours(i, [&](int neighbour) {
          const float z = at(depth_, neighbour);
          if (z <= 0 || at(seen, neighbour) != 0) return;
          if (std::abs(z - at(depth_, i)) > 2 * noise(z)) return;
          at(seen, neighbour) = 1;
          part.push_back(neighbour);
        });
      }
      if (!enclosed) continue;
      for (const int i : part) at(side_, i) = Side::kObject;
    }
  }

  template <class Visit>
  void visit_neighbours(int i, const Visit& visit) const {
    const int column = i % columns_;
    if (column > 0) visit(i - 1);
    if (column + 1 < columns_) visit(i + 1);
    if (i >= columns_) visit(i - columns_);
    if (i + columns_ < size()) visit(i + columns_);
  }

  PixelBox box_;
  bool is_rough_;
  int stride_ = 2;
  cv::Rect area_;
  int columns_ = 0, rows_ = 0;
  std::vector<float> depth_;
  std::vector<Side> side_;
  std::vector<std::uint8_t> own_;  // 1 in the rough mask
};

/// The pixels of `area` that belong to the object by the grid; those without depth by the rough
/// mask if there is one.
PixelPatch pixels_of_object(const CellGrid& grid,
                            const DepthImage& depth,
                            const ObjectMask& mask,
                            cv::Rect area,
                            int rough_id) {
  PixelPatch patch{area, cv::Mat1b(area.size(), std::uint8_t{0})};
  const auto id_at = [&](int y, int x) { return mask.mat.empty() ? 0 : int{mask.mat(y, x)}; };
  // Cells leave out some of the last rows and columns.
  if (rough_id != 0) cv::Mat1b((mask.mat(area) == rough_id) & 1).copyTo(patch.pixels);
  for (int i = 0; i < grid.size(); ++i) {
    const cv::Rect cell = grid.cell(i) & area;
    const float reach = 0.05F + 0.02F * grid.depth(i);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        const float z = depth.mat(y, x);
        const int id = id_at(y, x);
        const bool own = rough_id != 0 && id == rough_id;
        const bool near = own || std::abs(z - grid.depth(i)) < reach;
        const bool undecided = !(grid.depth(i) > 0);
        const bool joins = z > 0 ? (grid.is_object(i) && near) || (undecided && own)
                                 : own || (rough_id == 0 && grid.is_object(i));
        patch.pixels(y - area.y, x - area.x) = (id == 0 || own) && joins ? 1 : 0;
      }
    }
  }
  return patch;
}

PixelBox widened(const PixelBox& box, double share) {
  const double x = share * box.width(), y = share * box.height();
  return {box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y};
}

/// Descending score; rough masks before boxes alone, which get what these leave.
std::vector<std::size_t> order_of_completion(const FrameDetections& detections) {
  std::vector<std::size_t> order(detections.objects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) {
    const DetectedObject& object = detections.objects[i];
    return std::pair(object.pixel_source == PixelSource::kRoughNetwork, object.score);
  });
  return order;
}

}  // namespace

PixelPatch mask_from_depth(const DepthImage& depth,
                           const ObjectMask& mask,
                           const PixelBox& box,
                           std::optional<float> expected_depth_m) {
  STILLMAP_CHECK(mask.mat.empty() || mask.mat.size() == depth.mat.size());
  const cv::Rect pixels = pixels_of(box, depth.mat.size());
  if (pixels.width < kLeastSide_px || pixels.height < kLeastSide_px) return {};
  CellGrid grid(depth, mask, box, 0);
  const std::optional<float> layer = grid.layer(expected_depth_m);
  if (!layer) return {};
  grid.divide(*layer);
  return pixels_of_object(grid, depth, mask, pixels, 0);
}

PixelPatch mask_refined_by_depth(const DepthImage& depth,
                                 const ObjectMask& mask,
                                 const DetectedObject& object) {
  STILLMAP_CHECK(mask.mat.size() == depth.mat.size());
  const PixelBox box = widened(object.box, kRoughReach);
  const cv::Rect pixels = pixels_of(box, depth.mat.size());
  if (pixels.width < kLeastSide_px || pixels.height < kLeastSide_px) return {};
  CellGrid grid(depth, mask, box, object.id);
  const std::optional<float> layer = grid.layer(std::nullopt);
  if (!layer || grid.measured_share() < kLeastMeasured) return {};
  grid.divide(*layer);
  return pixels_of_object(grid, depth, mask, pixels, object.id);
}

std::vector<bool> complete_masks(FrameDetections& detections,
                                 const DepthImage& depth,
                                 const std::vector<std::optional<float>>& expected_depths_m) {
  STILLMAP_CHECK(expected_depths_m.size() == detections.objects.size());
  const MaskAreas areas = mask_areas(detections.mask);
  std::vector<bool> completed(detections.objects.size(), false);
  bool own = false;  // the mask's pixels may be shared with the caller
  for (const std::size_t i : order_of_completion(detections)) {
    DetectedObject& object = detections.objects[i];
    const bool has_pixels = areas[static_cast<std::size_t>(object.id)].pixels > 0;
    if (has_pixels && object.pixel_source != PixelSource::kRoughNetwork) continue;
    const PixelPatch patch =
        has_pixels ? mask_refined_by_depth(depth, detections.mask, object)
                   : mask_from_depth(depth, detections.mask, object.box, expected_depths_m[i]);
    object.pixel_source = has_pixels ? PixelSource::kNetwork : object.pixel_source;
    if (patch.area.empty() || cv::countNonZero(patch.pixels) == 0) continue;
    if (!own) {
      detections.mask =
          ObjectMask(detections.mask.mat.empty() ? cv::Mat1b(depth.mat.size(), std::uint8_t{0})
                                                 : cv::Mat1b(detections.mask.mat.clone()));
      own = true;
    }
    if (has_pixels) detections.mask.mat.setTo(0, detections.mask.mat == object.id);
    paint(detections.mask, patch, static_cast<std::uint8_t>(object.id));
    completed[i] = !has_pixels;
    if (!has_pixels) object.pixel_source = PixelSource::kDepth;
  }
  return completed;
}

}  // namespace stillmap
