// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/surface_mesh.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

void add(PointCloud& cloud, const Eigen::Vector3f& p, const Eigen::Vector3f& normal, Rgb color) {
  cloud.positions.push_back(p);
  cloud.normals.push_back(normal);
  cloud.colors.push_back(color);
  cloud.labels.push_back(p.z() > 0 ? 57 : 0);
}

/// Some evenly spread points of a sphere around the origin (a spiral of Fibonacci).
PointCloud sphere(float radius, int count) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3f out =
        Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    add(cloud, radius * out, out, {200, 100, 50});
  }
  return cloud;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// How often each directed edge occurs.
std::map<Edge, int> edges(const SurfaceMesh& mesh) {
  std::map<Edge, int> count;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  }
  return count;
}

Eigen::Vector3f face_normal(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const auto& p = mesh.vertices.positions;
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
}

TEST(SurfaceMesh, ASphereIsClosedAndRound) {
  const SurfaceMesh mesh = surface_mesh(sphere(0.3F, 12000), {.cell_m = 0.02});
  ASSERT_GT(mesh.triangles.size(), 1000U);
  for (const Eigen::Vector3f& p : mesh.vertices.positions) EXPECT_NEAR(p.norm(), 0.3F, 0.002F);
  // Closed: each edge has exactly one triangle on each side. A sphere: V - E + F = 2.
  const std::map<Edge, int> all = edges(mesh);
  for (const auto& [edge, count] : all) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(all.contains({edge.second, edge.first}));
  }
  const auto v = static_cast<int>(mesh.vertices.size());
  const auto f = static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(v - static_cast<int>(all.size()) / 2 + f, 2);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f normal = face_normal(mesh, t);
    area += 0.5 * normal.norm();
    EXPECT_GT(normal.dot(mesh.vertices.positions[t[0]]), 0);  // outwards
  }
  EXPECT_NEAR(area, 4 * std::numbers::pi * 0.09, 0.01);
}

TEST(SurfaceMesh, VerticesHaveTheAttributesOfThePointsAround) {
  const SurfaceMesh mesh = surface_mesh(sphere(0.3F, 12000));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices.positions[i];
    EXPECT_GT(mesh.vertices.normals[i].dot(p.normalized()), 0.99F);
    EXPECT_EQ(mesh.vertices.colors[i], (Rgb{200, 100, 50}));
    if (std::abs(p.z()) > 0.05F) {
      EXPECT_EQ(mesh.vertices.labels[i], p.z() > 0 ? 57 : 0);
    }
  }
}

/// A square of 1 m in the plane z = 0 whose points are 1 cm apart, with a hole of 30 cm.
PointCloud sheet(const Eigen::Vector3f& normal, float z) {
  PointCloud cloud;
  for (int x = -50; x <= 50; ++x) {
    for (int y = -50; y <= 50; ++y) {
      if (std::hypot(x, y) < 30) continue;
      const Eigen::Vector3f p(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), z);
      add(cloud, p, normal, {9, 9, 9});
    }
  }
  return cloud;
}

TEST(SurfaceMesh, EndsWhereThePointsDo) {
  const SurfaceMesh mesh = surface_mesh(sheet({0, 0, 1}, 0.003F));
  ASSERT_GT(mesh.vertices.size(), 500U);
  double area = 0;
  for (const auto& t : mesh.triangles) area += 0.5 * face_normal(mesh, t).norm();
  EXPECT_NEAR(area, 1 - std::numbers::pi * 0.09, 0.08);
  for (const Eigen::Vector3f& p : mesh.vertices.positions) {
    EXPECT_NEAR(p.z(), 0.003F, 1e-4F);
    EXPECT_GT(p.head<2>().norm(), 0.3F - 0.03F);
    EXPECT_LT(p.head<2>().cwiseAbs().maxCoeff(), 0.5F + 0.03F);
  }
}

TEST(SurfaceMesh, ABoardKeepsBothSides) {
  PointCloud board = sheet({0, 0, 1}, 0.01F);
  const PointCloud back = sheet({0, 0, -1}, -0.01F);
  for (std::size_t i = 0; i < back.size(); ++i) {
    add(board, back.positions[i], back.normals[i], back.colors[i]);
  }
  const SurfaceMesh mesh = surface_mesh(board, {.cell_m = 0.01});
  double front = 0, behind = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f normal = face_normal(mesh, t);
    (normal.z() > 0 ? front : behind) += 0.5 * normal.norm();
    EXPECT_EQ(normal.z() > 0, mesh.vertices.positions[t[0]].z() > 0);
  }
  EXPECT_NEAR(front, 1 - std::numbers::pi * 0.09, 0.08);
  EXPECT_NEAR(behind, front, 0.05);
}

TEST(SurfaceMesh, PointsWithoutNormalsMakeNone) {
  PointCloud cloud = sphere(0.3F, 1000);
  for (Eigen::Vector3f& normal : cloud.normals) normal.setZero();
  EXPECT_TRUE(surface_mesh(cloud).triangles.empty());
  EXPECT_TRUE(surface_mesh(PointCloud{}).triangles.empty());
}

TEST(SurfaceMesh, RefusesCellsWithoutNumber) {
  EXPECT_THROW((void)surface_mesh(sphere(0.3F, 12000), {.cell_m = 0.02, .most_cells = 1000}),
               Error);
}

}  // namespace
}  // namespace stillmap
