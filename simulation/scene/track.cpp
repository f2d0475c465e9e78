// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/track.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;

// The mean velocity of the pieces before and after a knot; the shorter one has more weight.
Vector3d rate_between(const Vector3d& before,
                      double h_before,
                      const Vector3d& after,
                      double h_after) {
  return (before / h_before * h_after + after / h_after * h_before) / (h_before + h_after);
}

double nearest_turn(double angle, double to) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle + kTurn * std::round((to - angle) / kTurn);
}

}  // namespace

double ease(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * c * (10.0 + c * (6.0 * c - 15.0));
}

EasedTrack::EasedTrack(std::vector<Key> keys) : keys_(std::move(keys)) {
  STILLMAP_CHECK(!keys_.empty());
  for (std::size_t i = 1; i < keys_.size(); ++i) STILLMAP_CHECK(keys_[i - 1].t_s < keys_[i].t_s);
}

double EasedTrack::at(double t_s) const {
  const auto after = std::upper_bound(
      keys_.begin(), keys_.end(), t_s, [](double t, const Key& key) { return t < key.t_s; });
  if (after == keys_.begin()) return keys_.front().value;
  if (after == keys_.end()) return keys_.back().value;
  const Key& before = *(after - 1);
  const double share = ease((t_s - before.t_s) / (after->t_s - before.t_s));
  return before.value + share * (after->value - before.value);
}

FloorPath::FloorPath(const std::vector<PathKey>& keys) {
  STILLMAP_CHECK(!keys.empty());
  const std::size_t last = keys.size() - 1;
  const auto rests = [&](std::size_t i) { return i == 0 || i == last || keys[i].stops; };
  for (const PathKey& key : keys) {
    knots_.push_back({key.t_s, {key.x, key.y, 0.0}, Vector3d::Zero()});
  }
  const auto set_rate = [&](std::size_t i, bool of_yaw) {
    if (rests(i)) return;
    const Knot& a = knots_[i - 1];
    const Knot& c = knots_[i + 1];
    Knot& b = knots_[i];
    const Vector3d rate =
        rate_between(b.value - a.value, b.t_s - a.t_s, c.value - b.value, c.t_s - b.t_s);
    b.rate =
        of_yaw ? Vector3d(b.rate.x(), b.rate.y(), rate.z()) : Vector3d(rate.x(), rate.y(), 0.0);
  };
  for (std::size_t i = 0; i <= last; ++i) {
    if (i > 0) STILLMAP_CHECK(keys[i - 1].t_s < keys[i].t_s);
    STILLMAP_CHECK(keys[i].yaw.has_value() || !rests(i));
    set_rate(i, false);
    const double heading = std::atan2(knots_[i].rate.y(), knots_[i].rate.x());
    knots_[i].value.z() =
        keys[i].yaw ? *keys[i].yaw : nearest_turn(heading, i > 0 ? knots_[i - 1].value.z() : 0.0);
  }
  for (std::size_t i = 0; i <= last; ++i) set_rate(i, true);
}

FloorPose FloorPath::at(double t_s) const {
  const auto after = std::upper_bound(
      knots_.begin(), knots_.end(), t_s, [](double t, const Knot& knot) { return t < knot.t_s; });
  if (after == knots_.begin() || after == knots_.end()) {
    const Vector3d& value = (after == knots_.begin() ? knots_.front() : knots_.back()).value;
    return {value.head<2>(), value.z()};
  }
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  const double h = b.t_s - a.t_s;
  const double u = (t_s - a.t_s) / h;
  const double v = 1.0 - u;
  const Vector3d value = (1.0 + 2.0 * u) * v * v * a.value + u * v * v * h * a.rate +
                         u * u * (3.0 - 2.0 * u) * b.value - u * u * v * h * b.rate;
  return {value.head<2>(), value.z()};
}

}  // namespace stillmap
