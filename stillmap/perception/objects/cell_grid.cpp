// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/cell_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "stillmap/perception/objects/boxes.hpp"

namespace stillmap {
namespace {

constexpr int kMostCells = 96;         // along the longer side of a box
constexpr double kMargin = 0.08;       // around a box, as a share of its side
constexpr double kRoughMargin = 0.15;  // the same, where planes that go on leave a rough mask
constexpr float kNearest_m = 0.2F;     // depth at which the first layer begins
constexpr double kLayerWidth = 0.04;   // of a class of depths, as a share of the depth
constexpr std::size_t kLayers = 110;   // up to 15 m
constexpr double kWorthwhile = 0.5;    // least size of a nearer layer, as a share of the strongest
constexpr float kThickness_m = 0.7F;   // greatest extent of an object from its layer
constexpr float kStepWay = 12;         // path length of a depth step beyond noise, in cells
constexpr float kDoubtWay = 3;  // path length of a cell that a rough mask gives to the other side
constexpr std::size_t kLeastPlane = 40;  // cells of a plane that may be furniture
constexpr double kGoesOn = 0.05;         // share of a plane outside the box, if it is furniture
constexpr int kLeastOutside = 10;        // cells of it there
constexpr double kWiderThanLimbs_m = 0.25;
constexpr double kFocalShare = 0.85;  // focal length of usual depth cameras, in image widths

template <class Values>
[[nodiscard]] auto& at(Values& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

std::size_t layer_of(float z) {
  const double k = std::log(static_cast<double>(z / kNearest_m)) / kLayerWidth;
  return std::min(kLayers - 1, static_cast<std::size_t>(k));
}

float noise(float z) {
  return 0.01F + 0.003F * z * z;
}

}  // namespace

CellGrid::CellGrid(const DepthImage& depth,
                   const ObjectMask& mask,
                   const PixelBox& box,
                   int rough_id)
    : box_(box), is_rough_(rough_id != 0) {
  const double longer = std::max(box.width(), box.height());
  stride_ = std::max(2, static_cast<int>(std::ceil(longer / kMostCells)));
  const double margin = is_rough_ ? kRoughMargin : kMargin;
  const double x = std::max<double>(2 * stride_, margin * box.width());
  const double y = std::max<double>(2 * stride_, margin * box.height());
  focal_px_ = kFocalShare * depth.mat.cols;
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

std::optional<float> CellGrid::layer(std::optional<float> expected_m) const {
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

void CellGrid::divide(float layer_m) {
  divide_by_paths(layer_m);
  // A leg behind the other one is a part of its own. A missed part does more harm than a false
  // one: only what is far from the layer leaves a rough mask.
  for (int i = 0; i < size(); ++i) {
    const bool near = at(depth_, i) > 0 && std::abs(at(depth_, i) - layer_m) < kThickness_m;
    if (at(own_, i) != 0 && near) at(side_, i) = Side::kObject;
  }
  if (is_rough_) leave_out_planes();
}

double CellGrid::measured_share() const {
  int own = 0, measured = 0;
  for (int i = 0; i < size(); ++i) {
    own += at(own_, i);
    measured += at(own_, i) != 0 && at(depth_, i) > 0 ? 1 : 0;
  }
  return own == 0 ? 0 : static_cast<double>(measured) / own;
}

void CellGrid::divide_by_paths(float layer_m) {
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

double CellGrid::off_middle(int i) const {
  const cv::Point p = pixel(i);
  const double x = (p.x - (box_.x0 + box_.x1) / 2) / (box_.width() / 2);
  const double y = (p.y - (box_.y0 + box_.y1) / 2) / (box_.height() / 2);
  return std::hypot(x, y);
}

double CellGrid::weight(int i) const {
  if (is_rough_) return at(own_, i);
  const double off = off_middle(i);
  return off < 1 ? std::exp(-2 * off * off) : 0;
}

bool CellGrid::in_box(int i) const {
  const cv::Point p = pixel(i);
  return p.x >= box_.x0 && p.x < box_.x1 && p.y >= box_.y0 && p.y < box_.y1;
}

float CellGrid::doubt(int from, int to) const {
  const bool as_mask = (at(side_, from) == Side::kObject) == (at(own_, to) != 0);
  return is_rough_ && !as_mask ? kDoubtWay : 0.0F;
}

bool CellGrid::is_core(int i) const {
  return is_rough_ ? at(own_, i) != 0 : off_middle(i) < 0.6;
}

void CellGrid::mark_certain(float layer_m) {
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

void CellGrid::claim_enclosed_parts(float layer_m) {
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

void CellGrid::leave_out_planes() {
  for (const PlanarPart& plane : planar_parts({depth_, columns_, rows_}, kLeastPlane)) {
    const auto outside = std::ranges::count_if(plane, [this](int i) { return !in_box(i); });
    const double share = static_cast<double>(outside) / static_cast<double>(plane.size());
    if (outside < kLeastOutside || share < kGoesOn || width_m(plane) < kWiderThanLimbs_m) continue;
    for (const int i : plane) at(side_, i) = Side::kOther;
  }
}

double CellGrid::width_m(const PlanarPart& plane) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const int i : plane) {
    const double z = at(depth_, i);
    const Eigen::Vector3d p(pixel(i).x / focal_px_ * z, pixel(i).y / focal_px_ * z, z);
    mean += p;
    squares += p * p.transpose();
  }
  mean /= static_cast<double>(plane.size());
  squares = squares / static_cast<double>(plane.size()) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares, Eigen::EigenvaluesOnly);
  return std::sqrt(12 * std::max(0.0, axes.eigenvalues()[1]));
}

}  // namespace stillmap
