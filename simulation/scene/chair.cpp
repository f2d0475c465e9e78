// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "simulation/scene/canvas.hpp"
#include "simulation/scene/furniture.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;

constexpr double kSeatTop = 0.46;

// Five spokes with castors, and the gas spring.
Mesh make_chair_base(Painter& painter) {
  const Surface plastic = painter.plain({46, 47, 50}), rubber = painter.plain({30, 30, 32});
  const Surface metal = painter.plain({150, 152, 156});
  Mesh wheel;  // lies on its side: its axis is that of the lathe
  wheel.append(make_lathe({{0, -0.01, rubber},
                           {0.022, -0.01, rubber},
                           {0.027, -0.006, rubber},
                           {0.027, 0.006, rubber},
                           {0.022, 0.01, rubber},
                           {0, 0.01, rubber}},
                          16),
               placed(0, 0, 0));
  Mesh mesh;
  for (int i = 0; i < 5; ++i) {
    const double yaw_deg = 72.0 * i + 36.0;
    Mesh spoke =
        make_tube({{{0.02, 0, 0.105}, {0.14, 0, 0.098}, {0.255, 0, 0.075}}, 0.024, 0.016}, plastic);
    spoke.append(make_tube({{{0.255, 0, 0.078}, {0.255, 0, 0.045}}, 0.009, 0.009}, metal, 8),
                 placed(0, 0, 0));
    for (const double side : {-1.0, 1.0}) {
      Eigen::Isometry3d T = placed(0.252, side * 0.016, 0.027);
      T.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()));
      spoke.append(wheel, T);
    }
    spoke.append(make_box({0.05, 0.046, 0.02}, all_faces(plastic), {0.006}),
                 placed(0.25, 0, 0.045));
    mesh.append(spoke, placed(0, 0, 0, yaw_deg));
  }
  mesh.append(make_lathe({{0, 0.075, plastic},
                          {0.036, 0.075, plastic},
                          {0.034, 0.16, plastic},
                          {0.027, 0.165, plastic},
                          {0.026, 0.26, metal},
                          {0.015, 0.261, metal},
                          {0.015, 0.36, metal},
                          {0, 0.36, metal}},
                         20),
              placed(0, 0, 0));
  mesh.append(make_tapered_box({{0.14, 0.1}, {0.22, 0.2}, 0.045}, all_faces(plastic)),
              placed(-0.02, 0, 0.345));
  mesh.append(make_tube({{{0.02, -0.08, 0.365}, {0.02, -0.24, 0.36}}, 0.006, 0.008}, plastic, 8),
              placed(0, 0, 0));
  return mesh;
}

Mesh make_armrest(const Surface& plastic, double side) {
  Mesh mesh = make_tube({{{-0.02, side * 0.17, 0.385},
                          {-0.02, side * 0.25, 0.395},
                          {-0.02, side * 0.27, 0.43},
                          {-0.01, side * 0.27, 0.64}},
                         0.016,
                         0.014},
                        plastic);
  mesh.append(make_box({0.24, 0.07, 0.03}, all_faces(plastic), {0.014, 3}),
              placed(0.02, side * 0.27, 0.635));
  return mesh;
}

}  // namespace

Mesh make_chair(Painter& painter, const cv::Vec3b& tone, bool armrests) {
  const Surface plastic = painter.plain({46, 47, 50});
  const Surface cloth =
      painter.repeated(fabric_picture({0.3, 0.3}, tone, painter.next_seed()), 0.3);
  const Surface back_cloth = painter.repeated(
      fabric_picture({0.3, 0.3}, blend(tone, {30, 30, 30}, 0.15), painter.next_seed()), 0.3);
  Mesh mesh = make_chair_base(painter);
  mesh.append(make_box({0.46, 0.46, 0.07}, all_faces(cloth), {0.034, 4, 4}),
              placed(0, 0, kSeatTop - 0.07));
  mesh.append(make_box({0.4, 0.4, 0.02}, all_faces(plastic), {0.006}), placed(0, 0, 0.375));
  // The backrest: its sides come forward, and it leans back a little at the top.
  constexpr double kBackHeight = 0.42;
  Mesh rest = make_box({0.055, 0.42, kBackHeight}, all_faces(back_cloth), {0.027, 4, 6});
  rest.append(make_box({0.03, 0.36, 0.34}, all_faces(plastic), {0.012, 2, 6}),
              placed(-0.022, 0, 0.04));
  mesh.append(bent(rest, {0.9, -0.35}), placed(-0.245, 0, 0.92 - kBackHeight));
  mesh.append(
      make_tube({{{-0.08, 0, 0.37}, {-0.25, 0, 0.375}, {-0.295, 0, 0.42}, {-0.292, 0, 0.72}},
                 0.02,
                 0.016},
                plastic),
      placed(0, 0, 0));
  if (armrests) {
    for (const double side : {-1.0, 1.0}) mesh.append(make_armrest(plastic, side), placed(0, 0, 0));
  }
  return mesh;
}

}  // namespace stillmap
