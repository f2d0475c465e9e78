// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// Finds the exact distance to the nearest of many points (a k-d tree of nanoflann).
class NearestPoints {
 public:
  /// The points are finite. Takes O(n log n).
  explicit NearestPoints(std::vector<Eigen::Vector3f> points);
  ~NearestPoints();

  /// Distance from the finite `p` to the nearest point, computed in double precision; infinity when
  /// none is nearer than `limit_m`. A small limit makes it fast.
  [[nodiscard]] double distance(const Eigen::Vector3f& p,
                                double limit_m = std::numeric_limits<double>::infinity()) const;

 private:
  struct Index;
  std::unique_ptr<const Index> index_;
};

}  // namespace stillmap
