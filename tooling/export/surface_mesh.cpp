// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/label_vote.hpp"
#include "tooling/export/point_buckets.hpp"

namespace stillmap {
namespace {

constexpr double kSupportCells = 2.5;  // radius around a place in which points count
constexpr double kBesideCells = 1.25;  // distance along the surface to the middle of these points
constexpr float kLeastWeight = 0.05F;

/// What the points around a place say of the surface there.
struct LocalSurface {
  Eigen::Vector3f normal;
  Rgb color;
  std::uint8_t label;
};

/// The signed distance that points with normals define.
class SignedDistance {
 public:
  SignedDistance(const PointCloud& map, double cell_m)
      : map_(map),
        radius_(static_cast<float>(kSupportCells * cell_m)),
        beside_(static_cast<float>(kBesideCells * cell_m)),
        buckets_(map.positions, radius_) {}

  /// Nothing where too few points are near.
  [[nodiscard]] std::optional<float> at(const Eigen::Vector3f& place) const {
    Sums sums;
    gather(place, sums, [](std::uint32_t, float) {});
    return sums.reaches(place, beside_) ? std::optional(sums.distance / sums.weight) : std::nullopt;
  }

  /// The surface near a place at which the distance is known.
  [[nodiscard]] LocalSurface near(const Eigen::Vector3f& place) const {
    Sums sums;
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    LabelVote labels;
    gather(place, sums, [&](std::uint32_t i, float weight) {
      const Rgb& rgb = map_.colors[i];
      color += weight * Eigen::Vector3f(rgb[0], rgb[1], rgb[2]);
      if (!map_.labels.empty()) {
        labels.add(map_.labels[i], static_cast<std::uint16_t>(1 + 255 * weight));
      }
    });
    LocalSurface surface;
    surface.normal = sums.normal.normalized();
    color /= sums.weight;
    for (std::size_t c = 0; c < 3; ++c) {
      surface.color[c] =
          static_cast<std::uint8_t>(std::lround(color[static_cast<Eigen::Index>(c)]));
    }
    surface.label = map_.labels.empty() ? std::uint8_t{0} : labels.winner();
    return surface;
  }

 private:
  struct Sums {
    float weight = 0, distance = 0;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();

    /// Whether the points lie around the place's foot on the surface, not to one side of it.
    [[nodiscard]] bool reaches(const Eigen::Vector3f& place, float beside) const {
      if (weight < kLeastWeight || normal.squaredNorm() <= 0) return false;
      const Eigen::Vector3f away = place - middle / weight, up = normal.normalized();
      return (away - away.dot(up) * up).norm() <= beside;
    }
  };

  /// Sums over the points around that face as the nearest one does: a board has two sides.
  template <class Each>
  void gather(const Eigen::Vector3f& place, Sums& sums, const Each& each) const {
    float least = radius_ * radius_;
    const Eigen::Vector3f* facing = nullptr;
    buckets_.for_each_near(place, [&](std::uint32_t i) {
      const float d2 = (map_.positions[i] - place).squaredNorm();
      if (d2 >= least || map_.normals[i].squaredNorm() <= 0) return;
      least = d2;
      facing = &map_.normals[i];
    });
    if (facing == nullptr) return;
    buckets_.for_each_near(place, [&](std::uint32_t i) {
      const Eigen::Vector3f& normal = map_.normals[i];
      if (normal.dot(*facing) <= 0) return;
      const Eigen::Vector3f away = place - map_.positions[i];
      const float share = away.norm() / radius_;
      if (share >= 1) return;
      const float rest = 1 - share;
      const float weight = rest * rest * rest * rest * (1 + 4 * share);
      sums.weight += weight;
      sums.distance += weight * normal.dot(away);
      sums.normal += weight * normal;
      sums.middle += weight * map_.positions[i];
      each(i, weight);
    });
  }

  const PointCloud& map_;
  float radius_, beside_;
  PointBuckets buckets_;
};

using Cell = Eigen::Vector3i;

constexpr std::array<std::array<int, 3>, 8> kCorners = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
constexpr std::array<std::pair<int, int>, 12> kEdges = {{{0, 1},
                                                         {2, 3},
                                                         {4, 5},
                                                         {6, 7},
                                                         {0, 2},
                                                         {1, 3},
                                                         {4, 6},
                                                         {5, 7},
                                                         {0, 4},
                                                         {1, 5},
                                                         {2, 6},
                                                         {3, 7}}};

Cell offset(const std::array<int, 3>& corner) {
  return {corner[0], corner[1], corner[2]};
}

/// The cubes with points and those beside them, in order, each once.
std::vector<Cell> cells_near(const PointCloud& map, double cell_m, std::size_t most) {
  CellSet cells;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.normals[i].squaredNorm() <= 0) continue;
    const std::optional<Cell> own = cell_of(map.positions[i], cell_m);
    if (own) cells.insert(*own);
  }
  if (cells.size() > most / 27) {
    throw Error("the mesh would have more than {} cells: give a larger cell", most);
  }
  return cells.with_neighbours();
}

class SurfaceNets {
 public:
  SurfaceNets(const PointCloud& map, const MeshOptions& options)
      : cell_m_(options.cell_m),
        distance_(map, options.cell_m),
        cells_(cells_near(map, options.cell_m, options.most_cells)) {}

  [[nodiscard]] SurfaceMesh mesh() {
    measure_corners();
    for (const Cell& cell : cells_) add_vertex(cell);
    for (const Cell& cell : cells_) add_quads(cell);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] Eigen::Vector3f place(const Cell& corner) const {
    return (corner.cast<double>() * cell_m_).cast<float>();
  }

  void measure_corners() {
    for (const Cell& cell : cells_) {
      for (const auto& corner : kCorners) {
        const Cell at = cell + offset(corner);
        if (const auto [slot, is_new] = corners_.insert(at); is_new) {
          const std::optional<float> distance = distance_.at(place(at));
          corner_distances_.push_back(distance.value_or(kUnknown));
        }
      }
    }
  }

  [[nodiscard]] float corner_distance(const Cell& corner) const {
    const std::optional<std::size_t> slot = corners_.find(corner);
    return slot ? corner_distances_[*slot] : kUnknown;
  }

  /// The vertex is the mean of the places where edges of the cube cross the surface.
  void add_vertex(const Cell& cell) {
    std::array<float, 8> d{};
    for (std::size_t k = 0; k < 8; ++k) {
      d[k] = corner_distance(cell + offset(kCorners[k]));
      if (d[k] == kUnknown) return;
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int crossings = 0;
    for (const auto& [a, b] : kEdges) {
      const float da = d[static_cast<std::size_t>(a)], db = d[static_cast<std::size_t>(b)];
      if ((da < 0) == (db < 0)) continue;
      const Eigen::Vector3f pa = place(cell + offset(kCorners[static_cast<std::size_t>(a)]));
      const Eigen::Vector3f pb = place(cell + offset(kCorners[static_cast<std::size_t>(b)]));
      sum += pa + da / (da - db) * (pb - pa);
      ++crossings;
    }
    if (crossings == 0) return;
    const Eigen::Vector3f p = sum / static_cast<float>(crossings);
    const LocalSurface surface = distance_.near(p);
    if (!surface.normal.allFinite()) return;
    vertices_.insert(cell);
    mesh_.vertices.positions.push_back(p);
    mesh_.vertices.normals.push_back(surface.normal);
    mesh_.vertices.colors.push_back(surface.color);
    mesh_.vertices.labels.push_back(surface.label);
  }

  /// A quad for each of the three edges at the cube's least corner that cross the surface.
  void add_quads(const Cell& cell) {
    const float here = corner_distance(cell);
    if (here == kUnknown) return;
    for (int axis = 0; axis < 3; ++axis) {
      const float there = corner_distance(cell + Cell::Unit(axis));
      if (there == kUnknown || (here < 0) == (there < 0)) continue;
      const Cell back = Cell::Unit((axis + 1) % 3), down = Cell::Unit((axis + 2) % 3);
      const std::array<std::optional<std::size_t>, 4> around = {vertices_.find(cell - back - down),
                                                                vertices_.find(cell - down),
                                                                vertices_.find(cell),
                                                                vertices_.find(cell - back)};
      if (std::ranges::any_of(around, [](const auto& v) { return !v; })) continue;
      std::array<std::uint32_t, 4> v{};
      for (std::size_t k = 0; k < 4; ++k) v[k] = static_cast<std::uint32_t>(*around[k]);
      if (here >= 0) std::swap(v[1], v[3]);
      mesh_.triangles.push_back({v[0], v[1], v[2]});
      mesh_.triangles.push_back({v[0], v[2], v[3]});
    }
  }

  static constexpr float kUnknown = 1e9F;

  double cell_m_;
  SignedDistance distance_;
  std::vector<Cell> cells_;
  CellSet corners_, vertices_;
  std::vector<float> corner_distances_;  // as in corners_
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh surface_mesh(const PointCloud& map, const MeshOptions& options) {
  STILLMAP_CHECK(options.cell_m > 0);
  STILLMAP_CHECK(map.normals.size() == map.size());
  return SurfaceNets(map, options).mesh();
}

}  // namespace stillmap
