// SPDX-License-Identifier: Apache-2.0
// The round shapes of shapes.hpp: lathe and tube.
#include <cmath>
#include <numbers>

#include "simulation/scene/shapes.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCreaseCosine = 0.7;  // sharper corners of a profile stay sharp

// Adds a ring of corners, its first one again at the end (there the picture starts anew).
struct Ring {
  std::vector<Vector3d> positions, normals;  // one a segment
  double u_scale, v;
};

std::uint32_t add_ring(Mesh& mesh, const Ring& ring) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t segments = ring.positions.size();
  for (std::size_t k = 0; k <= segments; ++k) {
    mesh.positions.push_back(ring.positions[k % segments].cast<float>());
    mesh.normals.push_back(ring.normals[k % segments].normalized().cast<float>());
    const double u = static_cast<double>(k) / static_cast<double>(segments);
    mesh.uvs.push_back(Vector2d(u * ring.u_scale, ring.v).cast<float>());
  }
  return first;
}

// Joins two rings; a ring that is one point only (a pole) gets one triangle a segment.
struct Band {
  std::uint32_t low, high;  // first corners
  bool low_is_point, high_is_point;
};

void add_band(Mesh& mesh, const Band& band, int segments, MaterialId material) {
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(segments); ++k) {
    if (!band.low_is_point) {
      mesh.triangles.push_back({band.low + k, band.low + k + 1, band.high + k + 1});
      mesh.materials.push_back(material);
    }
    if (!band.high_is_point) {
      mesh.triangles.push_back({band.low + k, band.high + k + 1, band.high + k});
      mesh.materials.push_back(material);
    }
  }
}

Vector2d stretch_normal(const ProfilePoint& from, const ProfilePoint& to) {
  return Vector2d(to.z - from.z, from.radius - to.radius).normalized();
}

Ring profile_ring(const ProfilePoint& point, const Vector2d& normal, int segments) {
  Ring ring{{}, {}, 1.0, 0.0};
  for (int k = 0; k < segments; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / segments;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    ring.positions.emplace_back(point.radius * out + point.z * Vector3d::UnitZ());
    ring.normals.emplace_back(normal.x() * out + normal.y() * Vector3d::UnitZ());
  }
  return ring;
}

bool same(const Surface& a, const Surface& b) {
  return a.material == b.material && a.tile_m == b.tile_m;
}

double length(const ProfilePoint& a, const ProfilePoint& b) {
  return std::hypot(a.radius - b.radius, a.z - b.z);
}

// A run of stretches with one picture: length before stretch `i`, whole length, greatest radius.
struct Run {
  double below = 0, whole = 0, widest = 0;
};

Run run_of(const std::vector<ProfilePoint>& profile, std::size_t i) {
  std::size_t first = i, last = i;
  while (first > 0 && same(profile[first - 1].surface, profile[i].surface)) --first;
  while (last + 2 < profile.size() && same(profile[last + 1].surface, profile[i].surface)) ++last;
  Run run;
  for (std::size_t k = first; k <= last; ++k) {
    if (k < i) run.below += length(profile[k], profile[k + 1]);
    run.whole += length(profile[k], profile[k + 1]);
    run.widest = std::max({run.widest, profile[k].radius, profile[k + 1].radius});
  }
  return run;
}

// The rings of a tube from start to end: position, radius, and how far the normals lean back.
struct TubeRing {
  Vector3d center, tangent;
  double radius, lean;
};

std::vector<TubeRing> tube_rings(const Tube& tube) {
  constexpr int kCapSteps = 3;
  const std::size_t count = tube.path.size();
  std::vector<TubeRing> rings;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d before =
        i > 0 ? (tube.path[i] - tube.path[i - 1]).normalized() : Vector3d::Zero();
    const Vector3d after =
        i + 1 < count ? (tube.path[i + 1] - tube.path[i]).normalized() : Vector3d::Zero();
    const Vector3d tangent = (before + after).normalized();
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double radius = (1.0 - share) * tube.start_radius + share * tube.end_radius;
    const auto add_cap = [&](int step, double sign) {
      const double angle = 0.5 * std::numbers::pi * step / kCapSteps;
      const double cap_radius = step == kCapSteps ? 0.0 : radius * std::cos(angle);
      rings.push_back({tube.path[i] + sign * radius * std::sin(angle) * tangent,
                       tangent,
                       cap_radius,
                       sign * angle});
    };
    if (i == 0) {
      for (int step = kCapSteps; step > 0; --step) add_cap(step, -1.0);
    }
    rings.push_back({tube.path[i], tangent, radius, 0.0});
    if (i + 1 == count) {
      for (int step = 1; step <= kCapSteps; ++step) add_cap(step, 1.0);
    }
  }
  return rings;
}

}  // namespace

Mesh make_lathe(const std::vector<ProfilePoint>& profile, int segments) {
  STILLMAP_CHECK(profile.size() >= 2 && segments >= 3);
  Mesh mesh;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Vector2d own = stretch_normal(profile[i], profile[i + 1]);
    const auto blended = [&](const Vector2d& other) {
      return other.dot(own) > kCreaseCosine ? Vector2d((own + other).normalized()) : own;
    };
    Vector2d low = own, high = own;
    if (i > 0) low = blended(stretch_normal(profile[i - 1], profile[i]));
    if (i + 2 < profile.size()) high = blended(stretch_normal(profile[i + 1], profile[i + 2]));

    const Surface& surface = profile[i].surface;
    const Run run = run_of(profile, i);
    const double unit = surface.tile_m > 0 ? surface.tile_m : run.whole;
    const double turn =
        surface.tile_m > 0 ? 2.0 * std::numbers::pi * run.widest / surface.tile_m : 1.0;
    Ring low_ring = profile_ring(profile[i], low, segments);
    Ring high_ring = profile_ring(profile[i + 1], high, segments);
    low_ring.u_scale = high_ring.u_scale = turn;
    low_ring.v = (run.whole - run.below) / unit;
    high_ring.v = (run.whole - run.below - length(profile[i], profile[i + 1])) / unit;
    const std::uint32_t a = add_ring(mesh, low_ring), b = add_ring(mesh, high_ring);
    add_band(mesh,
             {a, b, profile[i].radius == 0.0, profile[i + 1].radius == 0.0},
             segments,
             surface.material);
  }
  return mesh;
}

Mesh make_tube(const Tube& tube, const Surface& surface, int segments) {
  STILLMAP_CHECK(tube.path.size() >= 2 && segments >= 3);
  Mesh mesh;
  Vector3d side = Vector3d::Zero();  // carried along, so that the tube does not twist
  double walked = 0;
  std::vector<std::uint32_t> firsts;
  const std::vector<TubeRing> rings = tube_rings(tube);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const TubeRing& at = rings[i];
    if (i == 0) {
      side = at.tangent.unitOrthogonal();
    } else {
      side = Eigen::Quaterniond::FromTwoVectors(rings[i - 1].tangent, at.tangent) * side;
      walked += (at.center - rings[i - 1].center).norm();
    }
    const Vector3d third = at.tangent.cross(side);
    const double unit = surface.tile_m > 0 ? surface.tile_m : 1.0;
    Ring ring{{}, {}, 2.0 * std::numbers::pi * tube.start_radius / unit, walked / unit};
    for (int k = 0; k < segments; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / segments;
      const Vector3d out = std::cos(angle) * side + std::sin(angle) * third;
      ring.positions.emplace_back(at.center + at.radius * out);
      ring.normals.emplace_back(std::cos(at.lean) * out + std::sin(at.lean) * at.tangent);
    }
    firsts.push_back(add_ring(mesh, ring));
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    add_band(mesh,
             {firsts[i], firsts[i + 1], rings[i].radius == 0.0, rings[i + 1].radius == 0.0},
             segments,
             surface.material);
  }
  return mesh;
}

}  // namespace stillmap
