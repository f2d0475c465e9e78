// SPDX-License-Identifier: Apache-2.0
// Functions of furniture.hpp: walls and the things on them.
#include "simulation/scene/furniture.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kFrontFace = 1;  // the one towards -x

BoxSurfaces front(const Surface& all, const Surface& front) {
  BoxSurfaces surfaces = all_faces(all);
  surfaces[kFrontFace] = front;
  return surfaces;
}

// Four bars around an opening of `size`; the bars lie outside of it.
Mesh make_frame(cv::Size2d size, double bar, double depth, const Surface& surface) {
  Mesh mesh;
  const double x = -0.5 * depth;
  for (const double side : {-1.0, 1.0}) {
    mesh.append(make_box({depth, bar, size.height}, all_faces(surface), {0.002}),
                placed(x, side * 0.5 * (size.width + bar), 0));
    mesh.append(make_box({depth, size.width + 2 * bar, bar}, all_faces(surface), {0.002}),
                placed(x, 0, side < 0 ? -bar : size.height));
  }
  return mesh;
}

}  // namespace

Mesh make_framed(Painter& painter,
                 cv::Size2d size,
                 const Surface& picture,
                 const cv::Vec3b& frame) {
  const Surface bars = painter.plain(frame);
  const double bar = 0.018;
  const cv::Size2d opening(size.width - 2 * bar, size.height - 2 * bar);
  Mesh mesh;
  mesh.append(make_frame(opening, bar, 0.022, bars), placed(0, 0, bar));
  mesh.append(make_box({0.012, opening.width, opening.height}, front(bars, picture)),
              placed(-0.006, 0, bar));
  return mesh;
}

Mesh make_sheet_on_wall(Painter& painter, cv::Size2d size, const Surface& picture) {
  Mesh mesh;
  mesh.append(
      make_box({0.004, size.width, size.height}, front(painter.plain({236, 235, 230}), picture)),
      placed(-0.002, 0, 0));
  return mesh;
}

Mesh make_whiteboard(Painter& painter, cv::Size2d size) {
  const Surface picture = painter.picture(whiteboard_picture(size, painter.next_seed()));
  const Surface metal = painter.plain({168, 170, 174});
  Mesh mesh = make_framed(painter, size, picture, {164, 166, 170});
  mesh.append(make_box({0.07, 0.5 * size.width, 0.012}, all_faces(metal), {0.003}),
              placed(-0.045, 0, 0.004));
  const std::array<cv::Vec3b, 3> pens{
      cv::Vec3b(44, 74, 150), cv::Vec3b(180, 50, 46), cv::Vec3b(40, 40, 42)};
  for (std::size_t i = 0; i < pens.size(); ++i) {
    const double y = 0.13 * static_cast<double>(i) - 0.2;
    const Tube pen{{{-0.05, y, 0.024}, {-0.055, y + 0.1, 0.024}}, 0.008, 0.008};
    mesh.append(make_tube(pen, painter.plain(pens[i]), 8), placed(0, 0, 0));
  }
  mesh.append(make_box({0.035, 0.1, 0.03}, all_faces(painter.plain({60, 90, 130})), {0.004}),
              placed(-0.05, 0.24, 0.016));
  return mesh;
}

Mesh make_window(Painter& painter, cv::Size2d size) {
  const Surface white = painter.plain({238, 238, 235}), metal = painter.plain({150, 152, 156});
  const Surface view = painter.glowing(outdoor_picture(size, painter.next_seed()), 0.9F);
  Mesh mesh = make_frame(size, 0.06, 0.05, white);
  mesh.append(make_box({0.01, size.width, size.height}, front(white, view)), placed(-0.005, 0, 0));
  mesh.append(make_box({0.04, 0.06, size.height}, all_faces(white), {0.004}), placed(-0.025, 0, 0));
  mesh.append(make_box({0.03, size.width, 0.025}, all_faces(white), {0.003}),
              placed(-0.02, 0, 0.7 * size.height));
  mesh.append(make_box({0.16, size.width + 0.24, 0.03}, all_faces(white), {0.006, 2}),
              placed(-0.08, 0, -0.09));  // sill
  mesh.append(make_box({0.03, 0.02, 0.11}, all_faces(metal), {0.004}),
              placed(-0.055, 0.01, 0.42 * size.height));
  return mesh;
}

Mesh make_door(Painter& painter, cv::Size2d size) {
  const Surface frame = painter.plain({150, 132, 108}), metal = painter.plain({150, 152, 156});
  const Surface leaf = painter.picture(door_picture(size, painter.next_seed()));
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    mesh.append(make_box({0.06, 0.07, size.height + 0.07}, all_faces(frame), {0.004}),
                placed(-0.03, side * (0.5 * size.width + 0.035), 0));
  }
  mesh.append(make_box({0.06, size.width, 0.07}, all_faces(frame), {0.004}),
              placed(-0.03, 0, size.height));
  mesh.append(make_box({0.03, size.width - 0.006, size.height - 0.006}, front(frame, leaf)),
              placed(-0.015, 0, 0.003));
  const double y = 0.5 * size.width - 0.08;
  mesh.append(make_box({0.008, 0.04, 0.2}, all_faces(metal), {0.002}), placed(-0.034, y, 0.95));
  const Tube handle{
      {{-0.035, y, 1.08}, {-0.075, y, 1.08}, {-0.08, y - 0.02, 1.08}, {-0.08, y - 0.12, 1.08}},
      0.009,
      0.009};
  mesh.append(make_tube(handle, metal, 10), placed(0, 0, 0));
  return mesh;
}

Mesh make_radiator(Painter& painter, double width) {
  const Surface white = painter.plain({232, 232, 228}), grey = painter.plain({206, 207, 206});
  Mesh mesh;
  mesh.append(make_box({0.03, width, 0.52}, all_faces(grey)), placed(-0.065, 0, 0.13));
  const int fins = static_cast<int>(width / 0.065);
  for (int i = 0; i < fins; ++i) {
    mesh.append(make_box({0.085, 0.045, 0.58}, all_faces(white), {0.014, 2}),
                placed(-0.075, 0.065 * (i - 0.5 * (fins - 1)), 0.1));
  }
  for (const double z : {0.15, 0.62}) {
    const Tube pipe{
        {{-0.07, -0.5 * width, z}, {-0.07, 0.5 * width + 0.06, z}, {-0.02, 0.5 * width + 0.08, z}},
        0.012,
        0.012};
    mesh.append(make_tube(pipe, white, 8), placed(0, 0, 0));
  }
  const Surface knob = painter.plain({244, 244, 242});
  mesh.append(make_lathe({{0, 0, knob}, {0.024, 0, knob}, {0.02, 0.06, knob}, {0, 0.06, knob}}, 14),
              placed(-0.07, 0.5 * width + 0.06, 0.62));
  return mesh;
}

Mesh make_wall(Painter& painter, cv::Size2d size) {
  const Surface wall = painter.picture(plaster_picture(size, painter.next_seed()));
  const Surface skirting = painter.plain({188, 186, 180});
  Mesh mesh;
  mesh.append(make_box({0.1, size.width, size.height}, front(painter.plain({220, 217, 208}), wall)),
              placed(0.05, 0, 0));
  mesh.append(make_box({0.014, size.width - 0.03, 0.08}, all_faces(skirting), {0.003}),
              placed(-0.007, 0, 0));
  return mesh;
}

}  // namespace stillmap
