// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/depth_planes.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace stillmap {
namespace {

constexpr double kMostScatter = 0.4;

float tolerance_m(float z) {
  return 0.01F + 0.004F * z * z;
}

/// A plane as inverse depth over the grid, by least squares.
class InverseDepthPlane {
 public:
  void add(const Eigen::Vector3d& place, double inverse_depth) {
    squares_ += place * place.transpose();
    products_ += place * inverse_depth;
  }
  void fit() { coefficients_ = squares_.ldlt().solve(products_); }

  [[nodiscard]] bool holds(const Eigen::Vector3d& place, float z) const {
    return std::abs(difference(place, z)) <= 1;
  }
  /// Of the depth of the plane from z, as a share of the tolerance.
  [[nodiscard]] double difference(const Eigen::Vector3d& place, float z) const {
    const double inverse = coefficients_.dot(place);
    return inverse > 0 ? (1 / inverse - z) / tolerance_m(z) : std::numeric_limits<double>::max();
  }

 private:
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products_ = Eigen::Vector3d::Zero(), coefficients_ = Eigen::Vector3d::Zero();
};

class PartFinder {
 public:
  explicit PartFinder(const DepthCells& cells) : cells_(cells), taken_(cells.depth_m.size(), 0) {}

  /// The part that begins with the cells around one; empty where they form no plane.
  [[nodiscard]] PlanarPart part_from(int row, int column) {
    PlanarPart part;
    InverseDepthPlane plane;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int i = index(row + dy, column + dx);
        if (!is_free(i)) return {};
        part.push_back(i);
        plane.add(place(i), inverse(i));
      }
    }
    plane.fit();
    for (const int i : part) {
      if (!plane.holds(place(i), depth(i))) return {};
    }
    for (const int i : part) take(i);
    grow(part, plane);
    plane.fit();
    return scatter(part, plane) <= kMostScatter ? part : PlanarPart();
  }

 private:
  [[nodiscard]] double scatter(const PlanarPart& part, const InverseDepthPlane& plane) const {
    double sum = 0;
    for (const int i : part) sum += std::pow(plane.difference(place(i), depth(i)), 2);
    return std::sqrt(sum / static_cast<double>(part.size()));
  }
  void grow(PlanarPart& part, InverseDepthPlane& plane) {
    std::size_t fit_again_at = 2 * part.size();
    for (std::size_t next = 0; next < part.size(); ++next) {
      const int row = part[next] / cells_.columns, column = part[next] % cells_.columns;
      for (const auto& [y, x] :
           {std::pair(row, column - 1), {row, column + 1}, {row - 1, column}, {row + 1, column}}) {
        if (y < 0 || x < 0 || y >= cells_.rows || x >= cells_.columns) continue;
        const int i = index(y, x);
        if (!is_free(i) || !plane.holds(place(i), depth(i))) continue;
        take(i);
        part.push_back(i);
        plane.add(place(i), inverse(i));
      }
      if (part.size() < fit_again_at) continue;
      plane.fit();
      fit_again_at = 2 * part.size();
    }
  }

  [[nodiscard]] int index(int row, int column) const { return row * cells_.columns + column; }
  [[nodiscard]] float depth(int i) const { return cells_.depth_m[static_cast<std::size_t>(i)]; }
  [[nodiscard]] double inverse(int i) const { return 1.0 / static_cast<double>(depth(i)); }
  [[nodiscard]] Eigen::Vector3d place(int i) const {
    return {1.0, i % cells_.columns * 0.01, i / cells_.columns * 0.01};
  }
  [[nodiscard]] bool is_free(int i) const {
    return depth(i) > 0 && taken_[static_cast<std::size_t>(i)] == 0;
  }
  void take(int i) { taken_[static_cast<std::size_t>(i)] = 1; }

  DepthCells cells_;
  std::vector<std::uint8_t> taken_;
};

}  // namespace

std::vector<PlanarPart> planar_parts(const DepthCells& cells, std::size_t least) {
  PartFinder finder(cells);
  std::vector<PlanarPart> parts;
  for (int row = 1; row + 1 < cells.rows; ++row) {
    for (int column = 1; column + 1 < cells.columns; ++column) {
      PlanarPart part = finder.part_from(row, column);
      if (part.size() >= least) parts.push_back(std::move(part));
    }
  }
  return parts;
}

}  // namespace stillmap
