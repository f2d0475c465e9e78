// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/nearest_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace stillmap {
namespace {

constexpr std::size_t kLeafSize = 8;

double square(double value) {
  return value * value;
}

}  // namespace

NearestPoints::NearestPoints(std::vector<Eigen::Vector3f> points)
    : points_(std::move(points)), axes_(points_.size(), 0) {
  build(0, points_.size());
}

void NearestPoints::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeafSize) return;
  Eigen::AlignedBox3f box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points_[i]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return points_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(
      at(begin), at(middle), at(end), [axis](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
        return a[axis] < b[axis];
      });
  axes_[middle] = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

void NearestPoints::search(const Eigen::Vector3f& p,
                           std::size_t begin,
                           std::size_t end,
                           double& best) const {
  const auto consider = [&](const Eigen::Vector3f& q) {
    best = std::min(best, (p.cast<double>() - q.cast<double>()).squaredNorm());
  };
  if (end - begin <= kLeafSize) {
    for (std::size_t i = begin; i < end; ++i) consider(points_[i]);
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const std::uint8_t axis = axes_[middle];
  const double beyond = static_cast<double>(p[axis]) - static_cast<double>(points_[middle][axis]);
  consider(points_[middle]);
  if (beyond < 0) {
    search(p, begin, middle, best);
    if (square(beyond) < best) search(p, middle + 1, end, best);
  } else {
    search(p, middle + 1, end, best);
    if (square(beyond) < best) search(p, begin, middle, best);
  }
}

double NearestPoints::distance(const Eigen::Vector3f& p, double limit_m) const {
  const double limit = square(limit_m);
  double best = limit;
  search(p, 0, points_.size(), best);
  return best < limit ? std::sqrt(best) : std::numeric_limits<double>::infinity();
}

}  // namespace stillmap
