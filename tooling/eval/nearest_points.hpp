// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// Answers how far the nearest of many points is, exactly (a k-d tree).
class NearestPoints {
 public:
  /// The points are finite. Takes O(n log n).
  explicit NearestPoints(std::vector<Eigen::Vector3f> points);

  /// Distance from the finite `p` to the nearest point, computed in double precision; infinity when
  /// there is none nearer than `limit_m`. A small limit makes a fast answer.
  [[nodiscard]] double distance(const Eigen::Vector3f& p,
                                double limit_m = std::numeric_limits<double>::infinity()) const;

 private:
  void build(std::size_t begin, std::size_t end);
  void search(const Eigen::Vector3f& p, std::size_t begin, std::size_t end, double& best) const;

  // A range of points is split at its middle one, along the axis noted there; a small one is not.
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint8_t> axes_;
};

}  // namespace stillmap
