// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/nearest_points.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include <nanoflann.hpp>

namespace stillmap {
namespace {

constexpr std::size_t kLeafSize = 8;

/// The points in the form that nanoflann needs. It measures in double precision.
struct Cloud {
  std::vector<Eigen::Vector3f> points;

  // NOLINTBEGIN(readability-identifier-naming): nanoflann's names.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return static_cast<double>(points[i][static_cast<Eigen::Index>(axis)]);
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;  // nanoflann computes it
  }
  // NOLINTEND(readability-identifier-naming)
};

}  // namespace

struct NearestPoints::Index {
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

  explicit Index(std::vector<Eigen::Vector3f> points)
      : cloud{std::move(points)},
        tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}

  Cloud cloud;
  Tree tree;
};

NearestPoints::NearestPoints(std::vector<Eigen::Vector3f> points)
    : index_(std::make_unique<const Index>(std::move(points))) {}

NearestPoints::~NearestPoints() = default;

double NearestPoints::distance(const Eigen::Vector3f& p, double limit_m) const {
  std::size_t nearest = 0;
  double squared = 0;
  nanoflann::KNNResultSet<double, std::size_t> result(1);
  result.init(&nearest, &squared);
  squared = limit_m * limit_m;  // the greatest distance searched
  const Eigen::Vector3d query = p.cast<double>();
  index_->tree.findNeighbors(result, query.data(), {});
  if (result.size() == 0) return std::numeric_limits<double>::infinity();
  return (query - index_->cloud.points[nearest].cast<double>()).norm();
}

}  // namespace stillmap
