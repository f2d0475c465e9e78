// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::uint32_t add_corner(Mesh& mesh,
                         const Vector3d& p,
                         const Vector3d& normal,
                         const Vector2d& uv) {
  mesh.positions.push_back(p.cast<float>());
  mesh.normals.push_back(normal.normalized().cast<float>());
  mesh.uvs.push_back(uv.cast<float>());
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(Mesh& mesh, const Mesh::Triangle& triangle, MaterialId material) {
  mesh.triangles.push_back(triangle);
  mesh.materials.push_back(material);
}

// Corners of a grid, row by row, become triangles; rows go down and columns right as seen from
// outside.
void add_grid(Mesh& mesh, std::uint32_t first, int columns, int rows, MaterialId material) {
  const std::uint32_t stride = static_cast<std::uint32_t>(columns) + 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a =
          first + static_cast<std::uint32_t>(row) * stride + static_cast<std::uint32_t>(column);
      add_triangle(mesh, {a, a + stride, a + stride + 1}, material);
      add_triangle(mesh, {a, a + stride + 1, a + 1}, material);
    }
  }
}

// A face of a box as seen from outside.
struct FaceAxes {
  Vector3d normal, right, up;
};

FaceAxes face_axes(std::size_t face) {
  Vector3d normal = Vector3d::Zero();
  normal[static_cast<Eigen::Index>(face / 2)] = face % 2 == 0 ? 1.0 : -1.0;
  const Vector3d up = face >= 4 ? Vector3d::UnitX() : Vector3d::UnitZ();
  return {normal, up.cross(normal), up};
}

// The cuts of a box's surface along one axis, relative to its middle: symmetric, so that
// neighbouring faces meet at the same points.
std::vector<double> cuts(double half, const Rounding& rounding) {
  std::vector<double> places;
  const double flat = half - rounding.radius;
  for (int i = rounding.edge_steps; i > 0 && rounding.radius > 0; --i) {
    const double tangent =
        i == rounding.edge_steps ? 1.0 : std::tan(std::numbers::pi / 4.0 * i / rounding.edge_steps);
    places.push_back(-flat - rounding.radius * tangent);
  }
  const std::size_t corners = places.size();
  const int steps = flat > 1e-6 ? rounding.flat_steps : 0;
  for (int i = 0; i <= steps; ++i) {
    places.push_back(steps == 0 ? 0.0 : -flat + 2.0 * flat * i / steps);
  }
  for (std::size_t i = corners; i > 0; --i) places.push_back(-places[i - 1]);
  return places;
}

Vector2d uv_on(const Surface& surface, const Vector2d& place, const Vector2d& size) {
  return surface.tile_m > 0 ? Vector2d(place / surface.tile_m) : place.cwiseQuotient(size);
}

// Joins the edges of a sheet's front, which comes first, and back: once around the front,
// counter-clockwise as seen from there.
void add_rim(Mesh& mesh, int columns, int rows, MaterialId material) {
  std::vector<std::array<int, 2>> rim;
  for (int i = 0; i < rows; ++i) rim.push_back({0, i});
  for (int i = 0; i < columns; ++i) rim.push_back({i, rows});
  for (int i = rows; i > 0; --i) rim.push_back({columns, i});
  for (int i = columns; i > 0; --i) rim.push_back({i, 0});
  const auto index = [&](const std::array<int, 2>& place, bool on_front) {
    const int column = on_front ? place[0] : columns - place[0];
    const int half = on_front ? 0 : (rows + 1) * (columns + 1);
    return static_cast<std::size_t>(half + place[1] * (columns + 1) + column);
  };
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const std::array<int, 2>&here = rim[i], &next = rim[(i + 1) % rim.size()];
    const std::array<std::size_t, 4> quad{
        index(here, true), index(next, true), index(here, false), index(next, false)};
    const Vector3d along = (mesh.positions[quad[1]] - mesh.positions[quad[0]]).cast<double>();
    const Vector3d across = (mesh.positions[quad[0]] - mesh.positions[quad[2]]).cast<double>();
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::size_t corner : quad) {
      add_corner(mesh, mesh.positions[corner].cast<double>(), along.cross(across), {0, 0});
    }
    add_triangle(mesh, {first, first + 2, first + 3}, material);
    add_triangle(mesh, {first, first + 3, first + 1}, material);
  }
}

}  // namespace

BoxSurfaces all_faces(const Surface& surface) {
  BoxSurfaces surfaces;
  surfaces.fill(surface);
  return surfaces;
}

Mesh make_box(const Vector3d& size, const BoxSurfaces& surfaces, const Rounding& rounding) {
  STILLMAP_CHECK(size.minCoeff() > 0 && rounding.radius <= 0.5 * size.minCoeff() + 1e-9);
  const Vector3d half = 0.5 * size, lift(0, 0, half.z());
  const Vector3d core = half - Vector3d::Constant(rounding.radius);
  Mesh mesh;
  for (std::size_t face = 0; face < 6; ++face) {
    const FaceAxes axes = face_axes(face);
    const Vector2d extent(size.dot(axes.right.cwiseAbs()), size.dot(axes.up.cwiseAbs()));
    const std::vector<double> columns = cuts(0.5 * extent.x(), rounding);
    const std::vector<double> rows = cuts(0.5 * extent.y(), rounding);
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double down : rows) {
      for (const double right : columns) {
        const Vector3d q = axes.normal.cwiseProduct(half) + right * axes.right - down * axes.up;
        const Vector3d inner = q.cwiseMax(-core).cwiseMin(core);
        const Vector3d normal = rounding.radius > 0 ? (q - inner).normalized() : axes.normal;
        const Vector2d place(right + 0.5 * extent.x(), down + 0.5 * extent.y());
        add_corner(mesh,
                   inner + rounding.radius * normal + lift,
                   normal,
                   uv_on(surfaces[face], place, extent));
      }
    }
    add_grid(mesh,
             first,
             static_cast<int>(columns.size()) - 1,
             static_cast<int>(rows.size()) - 1,
             surfaces[face].material);
  }
  return mesh;
}

Mesh make_tapered_box(const TaperedBox& shape, const BoxSurfaces& surfaces) {
  const auto corner = [&](const Vector3d& sign) {
    const bool top = sign.z() > 0;
    const Vector2d half = 0.5 * (top ? shape.top_size : shape.bottom_size);
    Vector3d p(sign.x() * half.x(), sign.y() * half.y(), top ? shape.height : 0.0);
    if (top) p.head<2>() += shape.top_offset;
    return p;
  };
  Mesh mesh;
  for (std::size_t face = 0; face < 6; ++face) {
    const FaceAxes axes = face_axes(face);
    std::array<Vector3d, 4> quad;  // rows down, columns right
    for (std::size_t i = 0; i < 4; ++i) {
      const double right = i % 2 == 0 ? -1.0 : 1.0, up = i < 2 ? 1.0 : -1.0;
      quad[i] = corner(axes.normal + right * axes.right + up * axes.up);
    }
    const Vector3d normal = (quad[1] - quad[2]).cross(quad[0] - quad[3]);
    const Vector2d extent((quad[3] - quad[2]).norm(), (quad[0] - quad[2]).norm());
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d place(i % 2 == 0 ? 0.0 : extent.x(), i < 2 ? 0.0 : extent.y());
      add_corner(mesh, quad[i], normal, uv_on(surfaces[face], place, extent));
    }
    add_grid(mesh, first, 1, 1, surfaces[face].material);
  }
  return mesh;
}

Mesh make_sheet(const Sheet& sheet, const Surface& front, const Surface& back) {
  const int columns = sheet.columns, rows = sheet.rows;
  const auto at = [&](int column, int row) {
    return sheet.place(static_cast<double>(column) / columns, static_cast<double>(row) / rows);
  };
  const auto normal_at = [&](int column, int row) {
    const Vector3d right =
        at(std::min(column + 1, columns), row) - at(std::max(column - 1, 0), row);
    const Vector3d down = at(column, std::min(row + 1, rows)) - at(column, std::max(row - 1, 0));
    return Vector3d(down.cross(right).normalized());
  };
  Vector2d extent = Vector2d::Zero();  // along the middle lines
  for (int i = 0; i < columns; ++i) extent.x() += (at(i + 1, rows / 2) - at(i, rows / 2)).norm();
  for (int i = 0; i < rows; ++i) extent.y() += (at(columns / 2, i + 1) - at(columns / 2, i)).norm();
  Mesh mesh;
  for (const double side : {1.0, -1.0}) {
    const Surface& surface = side > 0 ? front : back;
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int row = 0; row <= rows; ++row) {
      for (int i = 0; i <= columns; ++i) {
        const int column = side > 0 ? i : columns - i;  // from behind, right is left
        const Vector3d normal = side * normal_at(column, row);
        const Vector2d place(extent.x() * i / columns, extent.y() * row / rows);
        add_corner(mesh,
                   at(column, row) + 0.5 * sheet.thickness * normal,
                   normal,
                   uv_on(surface, place, extent));
      }
    }
    add_grid(mesh, first, columns, rows, surface.material);
  }
  add_rim(mesh, columns, rows, back.material);
  return mesh;
}

Mesh bent(Mesh mesh, const Bend& bend) {
  const float cy = static_cast<float>(bend.along_y), cz = static_cast<float>(bend.along_z);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Eigen::Vector3f& p = mesh.positions[i];
    Eigen::Vector3f& n = mesh.normals[i];
    // Normals follow the inverse transpose of the bend's derivative.
    n = Eigen::Vector3f(n.x(), n.y() - cy * p.y() * n.x(), n.z() - cz * p.z() * n.x()).normalized();
    p.x() += 0.5F * (cy * p.y() * p.y() + cz * p.z() * p.z());
  }
  return mesh;
}

}  // namespace stillmap
