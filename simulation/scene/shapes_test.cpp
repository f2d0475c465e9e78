// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/shapes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

using Place = std::tuple<float, float, float>;

Place place(const Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

// How often each directed edge occurs; a closed surface has each edge once in each direction.
std::map<std::pair<Place, Place>, int> edges(const Mesh& mesh) {
  std::map<std::pair<Place, Place>, int> count;
  for (const Mesh::Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++count[{place(mesh.positions[t[i]]), place(mesh.positions[t[(i + 1) % 3]])}];
    }
  }
  return count;
}

void expect_closed(const Mesh& mesh) {
  const std::map<std::pair<Place, Place>, int> count = edges(mesh);
  int open = 0;
  for (const auto& [edge, times] : count) {
    const auto reverse = count.find({edge.second, edge.first});
    if (times != 1 || reverse == count.end() || reverse->second != 1) ++open;
  }
  EXPECT_EQ(open, 0);
}

// Normals are unit and lean to the side from which their triangles turn counter-clockwise.
void expect_good_normals(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  ASSERT_EQ(mesh.materials.size(), mesh.triangles.size());
  for (const Vector3f& n : mesh.normals) ASSERT_NEAR(n.norm(), 1.F, 1e-5F);
  for (const Mesh::Triangle& t : mesh.triangles) {
    const Vector3f& a = mesh.positions[t[0]];
    const Vector3f across = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
    ASSERT_GT(across.norm(), 0.F);
    for (const std::uint32_t corner : t) ASSERT_GT(across.dot(mesh.normals[corner]), 0.F);
  }
}

// By the divergence theorem: positive where triangles look outwards.
double volume(const Mesh& mesh) {
  double six_times = 0;
  for (const Mesh::Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.positions[t[0]].cast<double>();
    const Vector3d b = mesh.positions[t[1]].cast<double>();
    six_times += a.dot(b.cross(mesh.positions[t[2]].cast<double>()));
  }
  return six_times / 6.0;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Mesh::Triangle& t : mesh.triangles) {
    const Vector3f& a = mesh.positions[t[0]];
    sum += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  return sum;
}

const Surface kPlain{3, 0};

TEST(Box, IsClosedAndHasItsVolumeAndArea) {
  const Mesh mesh = make_box({0.4, 0.5, 0.6}, all_faces(kPlain));
  expect_closed(mesh);
  expect_good_normals(mesh);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_NEAR(volume(mesh), 0.12, 1e-7);
  EXPECT_NEAR(area(mesh), 2 * (0.2 + 0.24 + 0.3), 1e-6);
}

TEST(Box, StandsOnTheMiddleOfItsBottom) {
  const Mesh mesh = make_box({0.4, 0.5, 0.6}, all_faces(kPlain));
  Eigen::AlignedBox3f bounds;
  for (const Vector3f& p : mesh.positions) bounds.extend(p);
  EXPECT_TRUE(bounds.min().isApprox(Vector3f(-0.2F, -0.25F, 0.F)));
  EXPECT_TRUE(bounds.max().isApprox(Vector3f(0.2F, 0.25F, 0.6F)));
}

TEST(Box, RoundedIsABoxWithCylindersAndASphereForEdges) {
  const double r = 0.1, x = 0.4, y = 0.5, z = 0.6;
  const Mesh mesh = make_box({x, y, z}, all_faces(kPlain), {r, 8, 2});
  expect_closed(mesh);
  expect_good_normals(mesh);
  const double cx = x - 2 * r, cy = y - 2 * r, cz = z - 2 * r, pi = std::numbers::pi;
  const double expected = cx * cy * cz + 2 * r * (cx * cy + cy * cz + cz * cx) +
                          pi * r * r * (cx + cy + cz) + 4.0 / 3.0 * pi * r * r * r;
  EXPECT_NEAR(volume(mesh), expected, 0.002 * expected);
}

TEST(Box, WithEdgesOfHalfItsSizeIsASphere) {
  const Mesh mesh = make_box({0.2, 0.2, 0.2}, all_faces(kPlain), {0.1, 6});
  expect_closed(mesh);
  expect_good_normals(mesh);
  for (const Vector3f& p : mesh.positions)
    EXPECT_NEAR((p - Vector3f(0, 0, 0.1F)).norm(), 0.1F, 1e-6F);
}

// The corner of the mesh at a position whose normal is `normal`.
Eigen::Vector2f uv_at(const Mesh& mesh, const Vector3f& position, const Vector3f& normal) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if ((mesh.positions[i] - position).norm() < 1e-6F &&
        (mesh.normals[i] - normal).norm() < 1e-6F) {
      return mesh.uvs[i];
    }
  }
  ADD_FAILURE() << "no corner there";
  return {-1, -1};
}

TEST(Box, PicturesStandUprightOnSidesAndLieWithTheirTopAhead) {
  const Mesh mesh = make_box({2, 2, 2}, all_faces(kPlain));
  const Vector3f x = Vector3f::UnitX(), y = Vector3f::UnitY(), z = Vector3f::UnitZ();
  // From -x, looking at +x: left is +y, up is +z.
  EXPECT_EQ(uv_at(mesh, {-1, 1, 2}, -x), Eigen::Vector2f(0, 0));
  EXPECT_EQ(uv_at(mesh, {-1, -1, 0}, -x), Eigen::Vector2f(1, 1));
  // From -y, looking at +y: left is -x.
  EXPECT_EQ(uv_at(mesh, {-1, -1, 2}, -y), Eigen::Vector2f(0, 0));
  // From above, the top towards +x: left is +y.
  EXPECT_EQ(uv_at(mesh, {1, 1, 2}, z), Eigen::Vector2f(0, 0));
  EXPECT_EQ(uv_at(mesh, {-1, -1, 2}, z), Eigen::Vector2f(1, 1));
}

TEST(Box, RepeatedPicturesKeepTheirSize) {
  const Mesh mesh = make_box({2, 3, 1}, all_faces({0, 0.5}));
  EXPECT_EQ(uv_at(mesh, {-1, -1.5F, 0}, {-1, 0, 0}), Eigen::Vector2f(6, 2));
}

TEST(TaperedBox, IsAFrustum) {
  const Mesh mesh =
      make_tapered_box({{0.6, 0.4}, {0.3, 0.2}, 0.5, {0.05, 0.02}}, all_faces(kPlain));
  expect_closed(mesh);
  expect_good_normals(mesh);
  // h / 3 (A + B + sqrt(A B)) of similar top and bottom.
  EXPECT_NEAR(volume(mesh), 0.5 / 3.0 * (0.24 + 0.06 + 0.12), 1e-6);
}

TEST(Lathe, CylinderHasItsVolumeAndArea) {
  const double r = 0.3, h = 0.7;
  const Mesh mesh =
      make_lathe({{0, 0, kPlain}, {r, 0, kPlain}, {r, h, kPlain}, {0, h, kPlain}}, 180);
  expect_closed(mesh);
  expect_good_normals(mesh);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(volume(mesh), pi * r * r * h, 1e-3 * pi * r * r * h);
  EXPECT_NEAR(area(mesh), 2 * pi * r * (r + h), 2e-3);
}

TEST(Lathe, PictureGoesAroundOnceAndItsTopIsUp) {
  const Surface print{7, 0};
  const Mesh mesh =
      make_lathe({{0, 0, kPlain}, {1, 0, print}, {1, 1, print}, {1, 3, kPlain}, {0, 3, kPlain}}, 4);
  EXPECT_EQ(uv_at(mesh, {0, 1, 0}, {0, 1, 0}), Eigen::Vector2f(0.25F, 1.F));
  EXPECT_TRUE(uv_at(mesh, {-1, 0, 1}, {-1, 0, 0}).isApprox(Eigen::Vector2f(0.5F, 2.F / 3.F)));
  EXPECT_NEAR(uv_at(mesh, {-1, 0, 3}, {-1, 0, 0}).y(), 0.F, 1e-6F);
}

TEST(Tube, IsACapsule) {
  const double r = 0.05, pi = std::numbers::pi;
  const Mesh mesh = make_tube({{{0, 0, 0}, {0.3, 0.4, 0}}, r, r}, kPlain, 64);
  expect_closed(mesh);
  expect_good_normals(mesh);
  const double expected = pi * r * r * 0.5 + 4.0 / 3.0 * pi * r * r * r;
  EXPECT_NEAR(volume(mesh), expected, 0.03 * expected);  // the caps have three rings each
}

TEST(Tube, BendsWithoutGaps) {
  const Mesh mesh =
      make_tube({{{0, 0, 0}, {0.2, 0, 0.1}, {0.2, 0.2, 0.3}, {0, 0.3, 0.3}}, 0.03, 0.01}, kPlain);
  expect_closed(mesh);
  EXPECT_GT(volume(mesh), 0);
}

TEST(Sheet, IsAThinClosedPlate) {
  const auto place_of = [](double u, double v) { return Vector3d(u, 0.5 * v * v, 1.0 - v); };
  const Mesh mesh = make_sheet({place_of, 6, 40, 0.01}, kPlain, kPlain);
  expect_closed(mesh);
  expect_good_normals(mesh);
  // Arc length of y = v^2 / 2: (sqrt(2) + asinh(1)) / 2.
  const double length = 0.5 * (std::sqrt(2.0) + std::asinh(1.0));
  EXPECT_NEAR(volume(mesh), 0.01 * length, 1e-4);
}

TEST(Bend, KeepsNormalsUprightOnTheSurface) {
  const Mesh mesh = bent(make_box({0.1, 1, 1}, all_faces(kPlain), {0.02, 2, 12}), {0.8, -0.5});
  expect_closed(mesh);
  expect_good_normals(mesh);
  EXPECT_NEAR(volume(mesh),
              volume(make_box({0.1, 1, 1}, all_faces(kPlain), {0.02, 2, 12})),
              1e-4);  // a shear keeps volumes
}

}  // namespace
}  // namespace stillmap
