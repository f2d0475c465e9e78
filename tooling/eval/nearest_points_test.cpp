// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/nearest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Eigen::Vector3f> random_points(std::size_t count, std::uint32_t seed, bool on_lattice) {
  std::mt19937 random(seed);
  std::vector<Eigen::Vector3f> points;
  const auto coordinate = [&] {
    const double unit = static_cast<double>(random()) / 4294967296.0;
    return static_cast<float>(on_lattice ? std::floor(unit * 4) : unit * 3 - 1);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const float x = coordinate(), y = coordinate(), z = coordinate();
    points.emplace_back(x, y, z);
  }
  return points;
}

double by_brute_force(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& p) {
  double best = kInfinity;
  for (const Eigen::Vector3f& q : points) {
    best = std::min(best, (p.cast<double>() - q.cast<double>()).squaredNorm());
  }
  return std::sqrt(best);
}

TEST(NearestPoints, AgreeWithBruteForceToTheBit) {
  for (const bool on_lattice : {false, true}) {  // a lattice has many equal points and ties
    for (const std::size_t count : {0U, 1U, 8U, 9U, 10U, 100U, 3000U}) {
      const std::vector<Eigen::Vector3f> points = random_points(count, 1, on_lattice);
      const NearestPoints nearest(points);
      for (const Eigen::Vector3f& p : random_points(300, 2, false)) {
        EXPECT_EQ(nearest.distance(p), by_brute_force(points, p)) << count;
      }
      for (const Eigen::Vector3f& p : points) EXPECT_EQ(nearest.distance(p), 0.0);
    }
  }
}

TEST(NearestPoints, SeeNothingAtTheLimitOrBeyond) {
  const NearestPoints nearest({{1, 0, 0}, {5, 0, 0}});
  EXPECT_EQ(nearest.distance({3.5F, 0, 0}, 1.75), 1.5);
  EXPECT_EQ(nearest.distance({3.5F, 0, 0}, 1.5), kInfinity);
  EXPECT_EQ(nearest.distance({3.5F, 0, 0}, 1.25), kInfinity);
}

}  // namespace
}  // namespace stillmap
