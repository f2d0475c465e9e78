// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "simulation/render/ray_scene.hpp"

namespace stillmap {

/// The plane of a triangle at one time, prepared for intersection with rays.
struct TrianglePlane {
  Eigen::Vector3f corner, edge_u, edge_v, normal;
  Eigen::Vector3f dual_u, dual_v;  ///< their products with a point's offset are its coordinates

  TrianglePlane(const SurfaceTriangle& t, float time) {
    const auto at = [&](std::size_t k) {
      return t.moves ? Eigen::Vector3f((1 - time) * t.open[k] + time * t.close[k]) : t.open[k];
    };
    corner = at(0);
    edge_u = at(1) - corner;
    edge_v = at(2) - corner;
    normal = edge_u.cross(edge_v);
    const float scale = 1.F / std::max(normal.squaredNorm(), 1e-30F);
    dual_u = scale * edge_v.cross(normal);
    dual_v = scale * normal.cross(edge_u);
  }

  [[nodiscard]] Eigen::Vector2f coordinates(const Eigen::Vector3f& step) const {
    return {dual_u.dot(step), dual_v.dot(step)};
  }
};

/// The intersection of a ray with the plane of a triangle; possibly outside the triangle.
struct PlaneMeeting {
  Eigen::Vector3f direction;
  float inverse_along;  ///< 1 / (normal . direction)
  float t;
  Eigen::Vector2f at;  ///< barycentric

  PlaneMeeting(const TrianglePlane& plane,
               const Eigen::Vector3f& origin,
               const Eigen::Vector3f& ray_direction)
      : direction(ray_direction) {
    const Eigen::Vector3f offset = origin - plane.corner;
    const float along = plane.normal.dot(direction);
    inverse_along = 1.F / (std::abs(along) > 1e-20F ? along : 1e-20F);
    t = -plane.normal.dot(offset) * inverse_along;
    at = plane.coordinates(offset + t * direction);
  }

  /// The first-order motion of the intersection on the plane when the point of the ray here moves
  /// by `step`.
  [[nodiscard]] Eigen::Vector2f shift(const TrianglePlane& plane,
                                      const Eigen::Vector3f& step) const {
    return plane.coordinates(step - plane.normal.dot(step) * inverse_along * direction);
  }
};

}  // namespace stillmap
