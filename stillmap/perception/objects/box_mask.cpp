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

enum class Side : std::uint8_t { kUndecided, kObject, kOther };

template <class Values>
[[nodiscard]] auto& at(Values& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

/// The box and its surroundings in cells of several pixels, each with the depth of its middle.
class CellGrid {
 public:
  CellGrid(const DepthImage& depth, const ObjectMask& mask, const PixelBox& box) : box_(box) {
    const double longer = std::max(box.width(), box.height());
    stride_ = std::max(2, static_cast<int>(std::ceil(longer / kMostCells)));
    const double x = std::max<double>(2 * stride_, kMargin * box.width());
    const double y = std::max<double>(2 * stride_, kMargin * box.height());
    area_ = pixels_of({box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y}, depth.mat.size());
    columns_ = area_.width / stride_;
    rows_ = area_.height / stride_;
    depth_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    side_.assign(depth_.size(), Side::kUndecided);
    for (int i = 0; i < size(); ++i) {
      const cv::Point p = pixel(i);
      const bool taken = !mask.mat.empty() && mask.mat(p) != 0;
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
      const auto [length, i] = next.top();
      next.pop();
      if (length > at(way, i)) continue;
      visit_neighbours(i, [&](int neighbour) {
        const float z = at(depth_, neighbour);
        if (z <= 0) return;
        const float steps = std::max(0.0F, std::abs(z - at(depth_, i)) / noise(z) - 1);
        const float longer = length + 1 + kStepWay * std::min(steps, 10.0F);
        if (longer >= at(way, neighbour)) return;
        at(way, neighbour) = longer;
        at(side_, neighbour) = at(side_, i);
        next.emplace(longer, neighbour);
      });
    }
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
    const double off = off_middle(i);
    return off < 1 ? std::exp(-2 * off * off) : 0;
  }
  [[nodiscard]] bool in_box(int i) const {
    const cv::Point p = pixel(i);
    return p.x >= box_.x0 && p.x < box_.x1 && p.y >= box_.y0 && p.y < box_.y1;
  }

  void mark_certain(float layer_m) {
    for (int i = 0; i < size(); ++i) {
      const float z = at(depth_, i);
      if (z <= 0) continue;
      const float from_layer = std::abs(z - layer_m);
      if (!in_box(i) || from_layer > kThickness_m) at(side_, i) = Side::kOther;
      if (off_middle(i) < 0.6 && from_layer < 2 * static_cast<float>(kLayerWidth) * layer_m) {
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
  int stride_ = 2;
  cv::Rect area_;
  int columns_ = 0, rows_ = 0;
  std::vector<float> depth_;
  std::vector<Side> side_;
};

}  // namespace

PixelPatch mask_from_depth(const DepthImage& depth,
                           const ObjectMask& mask,
                           const PixelBox& box,
                           std::optional<float> expected_depth_m) {
  STILLMAP_CHECK(mask.mat.empty() || mask.mat.size() == depth.mat.size());
  const cv::Rect pixels = pixels_of(box, depth.mat.size());
  if (pixels.width < kLeastSide_px || pixels.height < kLeastSide_px) return {};
  CellGrid grid(depth, mask, box);
  const std::optional<float> layer = grid.layer(expected_depth_m);
  if (!layer) return {};
  grid.divide(*layer);
  PixelPatch patch{pixels, cv::Mat1b(pixels.size(), std::uint8_t{0})};
  for (int i = 0; i < grid.size(); ++i) {
    const cv::Rect cell = grid.cell(i) & pixels;
    if (!grid.is_object(i) || cell.empty()) continue;
    const float reach = 0.05F + 0.02F * grid.depth(i);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        const float z = depth.mat(y, x);
        const bool taken = !mask.mat.empty() && mask.mat(y, x) != 0;
        const bool joins = !taken && (!(z > 0) || std::abs(z - grid.depth(i)) < reach);
        patch.pixels(y - pixels.y, x - pixels.x) = joins ? 1 : 0;
      }
    }
  }
  return patch;
}

std::vector<bool> complete_masks(FrameDetections& detections,
                                 const DepthImage& depth,
                                 const std::vector<std::optional<float>>& expected_depths_m) {
  STILLMAP_CHECK(expected_depths_m.size() == detections.objects.size());
  const MaskAreas areas = mask_areas(detections.mask);
  std::vector<std::size_t> order(detections.objects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, std::ranges::greater{}, [&](std::size_t i) { return detections.objects[i].score; });
  std::vector<bool> completed(detections.objects.size(), false);
  bool own = false;  // the mask's pixels may be shared with the caller
  for (const std::size_t i : order) {
    const DetectedObject& object = detections.objects[i];
    if (areas[static_cast<std::size_t>(object.id)].pixels > 0) continue;
    const PixelPatch patch =
        mask_from_depth(depth, detections.mask, object.box, expected_depths_m[i]);
    if (patch.area.empty() || cv::countNonZero(patch.pixels) == 0) continue;
    if (!own) {
      detections.mask =
          ObjectMask(detections.mask.mat.empty() ? cv::Mat1b(depth.mat.size(), std::uint8_t{0})
                                                 : cv::Mat1b(detections.mask.mat.clone()));
      own = true;
    }
    paint(detections.mask, patch, static_cast<std::uint8_t>(object.id));
    completed[i] = true;
  }
  return completed;
}

}  // namespace stillmap
