// SPDX-License-Identifier: Apache-2.0
// Functions of furniture.hpp: things on the floor; the chair is in chair.cpp.
#include <cmath>
#include <numbers>

#include "simulation/scene/canvas.hpp"
#include "simulation/scene/furniture.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;

const std::vector<Paint> kSpines{{44, 70, 104},
                                 {130, 48, 44},
                                 {58, 92, 74},
                                 {190, 164, 112},
                                 {86, 76, 100},
                                 {218, 214, 204},
                                 {48, 50, 56},
                                 {176, 108, 62},
                                 {112, 134, 150},
                                 {150, 142, 128}};

// One standing book, its spine towards -y; x from 0 to its thickness.
Mesh make_standing_book(Painter& painter, const Vector3d& size, HashStream& tones) {
  const Paint tone = near_color(pick(kSpines, tones), 16, tones);
  const Surface cover = painter.plain(tone), pages = painter.plain({226, 220, 202});
  const Surface spine =
      painter.picture(book_spine_picture({size.x(), size.z()}, tone, painter.next_seed()));
  BoxSurfaces surfaces = all_faces(cover);
  surfaces[2] = surfaces[4] = surfaces[5] = pages;
  surfaces[3] = spine;
  Mesh mesh;
  mesh.append(make_box(size, surfaces), placed(0.5 * size.x(), 0, 0));
  return mesh;
}

// A leaf that leaves the z axis at `foot` in a direction, hangs down at its end.
struct Leaf {
  double foot_z, rise, length, width, yaw;
};

Mesh make_leaf(const Leaf& leaf, const Surface& green) {
  const double c = std::cos(leaf.yaw), s = std::sin(leaf.yaw);
  const auto place = [=](double u, double v) {
    const double along = 1.0 - v;  // the upper edge of its picture is the tip
    const double wide = leaf.width * (0.06 + std::sin(std::numbers::pi * (0.06 + 0.9 * along)));
    const double out = leaf.length * along * (1.0 - 0.25 * along);
    const double up = leaf.rise * (1.6 * along - along * along) * 1.6;
    const double side = (0.5 - u) * wide;
    const double fold = 0.35 * std::abs(side);
    return Vector3d(c * out - s * side, s * out + c * side, leaf.foot_z + up + fold);
  };
  return make_sheet({place, 4, 9, 0.002}, green, green);
}

// A jacket on a hook at about x = 0.1, z = 1.62: a body with folds, sleeves, a collar.
Mesh make_jacket(const Surface& cloth) {
  const auto place = [](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u * 0.98;
    const double fold = 1.0 + 0.1 * v * std::sin(7.0 * angle) + 0.05 * std::sin(3.0 * angle);
    const double r = std::min(0.05 + 0.9 * v, 0.15 + 0.05 * v) * fold;
    return Vector3d(0.09 + 0.55 * r * std::cos(angle), r * std::sin(angle), 1.64 - 0.72 * v);
  };
  Mesh mesh = make_sheet({place, 48, 24, 0.006}, cloth, cloth);
  for (const double side : {-1.0, 1.0}) {
    const Tube sleeve{{{0.09, side * 0.1, 1.53},
                       {0.1, side * 0.175, 1.44},
                       {0.12, side * 0.2, 1.2},
                       {0.14, side * 0.19, 0.98}},
                      0.06,
                      0.042};
    mesh.append(make_tube(sleeve, cloth, 14), placed(0, 0, 0));
  }
  mesh.append(
      make_lathe({{0, 0, cloth}, {0.075, 0, cloth}, {0.06, 0.06, cloth}, {0, 0.055, cloth}}, 20),
      placed(0.09, 0, 1.6));
  return mesh;
}

}  // namespace

Mesh make_shelf(Painter& painter, const ShelfSize& size) {
  const Paint tone(196, 164, 122);
  const Surface side =
      painter.picture(wood_picture({size.depth, size.height}, tone, painter.next_seed()));
  const Surface back = painter.plain({170, 140, 104}), edge = painter.plain({206, 178, 140});
  const double inner = size.width - 0.05, step = (size.height - 0.09) / (size.boards - 1);
  Mesh mesh;
  mesh.append(make_box({size.width, 0.012, size.height}, all_faces(back)),
              placed(0, 0.5 * size.depth - 0.006, 0));
  for (const double x : {-1.0, 1.0}) {
    mesh.append(make_box({0.025, size.depth - 0.012, size.height}, all_faces(side), {0.002}),
                placed(x * 0.5 * (size.width - 0.025), -0.006, 0));
  }
  for (int i = 0; i < size.boards; ++i) {
    mesh.append(make_box({inner, size.depth - 0.014, 0.025}, all_faces(edge)),
                placed(0, -0.006, 0.06 + step * i));
  }
  return mesh;
}

Mesh make_book_row(Painter& painter, double length, std::uint64_t layout_seed) {
  HashStream layout(layout_seed), tones(painter.next_seed());
  Mesh mesh;
  double x = 0;
  while (true) {
    const double thick = layout.uniform(0.016, 0.052), high = layout.uniform(0.19, 0.31);
    const double deep = layout.uniform(0.15, 0.2), back = layout.uniform(0.0, 0.03);
    if (x + thick > length) break;
    const Mesh book = make_standing_book(painter, {thick, deep, high}, tones);
    const bool leans = layout.below(9) == 0 && x + thick + 0.1 < length;
    Eigen::Isometry3d T = placed(x, back, 0);
    if (leans) {  // to the right, on the next book: its foot is left of its head
      T.translate(Vector3d(0, 0, thick * std::sin(0.2)));
      T.rotate(Eigen::AngleAxisd(0.2, Vector3d::UnitY()));
      x += high * std::sin(0.2);
    }
    mesh.append(book, T);
    x += thick + 0.001;
    if (layout.below(12) == 0) x += layout.uniform(0.02, 0.07);
  }
  return mesh;
}

Mesh make_binder_row(Painter& painter, int binders) {
  HashStream tones(painter.next_seed());
  Mesh mesh;
  for (int i = 0; i < binders; ++i) {
    const Paint tone =
        pick({{52, 54, 60}, {60, 80, 120}, {120, 50, 48}, {70, 100, 84}, {180, 180, 176}}, tones);
    const double thick = i % 3 == 1 ? 0.05 : 0.075;
    const Surface plain = painter.plain(tone);
    BoxSurfaces surfaces = all_faces(plain);
    surfaces[3] = painter.picture(binder_picture({thick, 0.315}, tone, painter.next_seed()));
    mesh.append(make_box({thick - 0.002, 0.27, 0.315}, surfaces, {0.003}),
                placed(0.08 * i + 0.04, 0.004 * (i % 4), 0));
  }
  return mesh;
}

Mesh make_cabinet(Painter& painter, const Vector3d& size) {
  const Surface metal = painter.plain({120, 122, 126}), body = painter.plain({190, 160, 122});
  const Surface top =
      painter.picture(wood_picture({size.y(), size.x()}, {196, 164, 122}, painter.next_seed()));
  BoxSurfaces plate = all_faces(body);
  plate[4] = top;
  Mesh mesh;
  mesh.append(make_box({size.x() - 0.03, size.y() - 0.02, size.z() - 0.07}, all_faces(body)),
              placed(0.01, 0, 0.05));
  mesh.append(
      make_box({size.x() - 0.08, size.y() - 0.06, 0.05}, all_faces(painter.plain({60, 60, 62}))),
      placed(0.02, 0, 0));
  mesh.append(make_box({size.x(), size.y(), 0.02}, plate, {0.003}), placed(0, 0, size.z() - 0.02));
  for (const double side : {-1.0, 1.0}) {
    const double width = 0.5 * size.y() - 0.014, height = size.z() - 0.08;
    const Surface door =
        painter.picture(wood_picture({width, height}, {204, 176, 136}, painter.next_seed()));
    BoxSurfaces leaf = all_faces(body);
    leaf[1] = door;
    mesh.append(make_box({0.018, width, height}, leaf, {0.003}),
                placed(-0.5 * size.x() + 0.016, side * (0.5 * width + 0.002), 0.055));
    const double x = -0.5 * size.x() + 0.007, y = side * 0.035, z = 0.55 * size.z();
    const Tube grip{
        {{x, y, z}, {x - 0.022, y, z + 0.006}, {x - 0.022, y, z + 0.114}, {x, y, z + 0.12}},
        0.005,
        0.005};
    mesh.append(make_tube(grip, metal, 8), placed(0, 0, 0));
  }
  return mesh;
}

Mesh make_side_table(Painter& painter, const Vector3d& size) {
  const Surface white = painter.plain({222, 220, 214}), metal = painter.plain({112, 114, 118});
  const Surface top =
      painter.picture(wood_picture({size.y(), size.x()}, {172, 132, 92}, painter.next_seed()));
  BoxSurfaces plate = all_faces(painter.plain({150, 114, 80}));
  plate[4] = top;
  Mesh mesh;
  mesh.append(make_box({size.x(), size.y(), 0.025}, plate, {0.004}),
              placed(0, 0, size.z() - 0.025));
  mesh.append(make_box({size.x() - 0.08, size.y() - 0.08, 0.015}, all_faces(white), {0.003}),
              placed(0, 0, 0.2));
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      mesh.append(
          make_tapered_box({{0.025, 0.025}, {0.04, 0.04}, size.z() - 0.025}, all_faces(metal)),
          placed(x * (0.5 * size.x() - 0.04), y * (0.5 * size.y() - 0.04), 0));
    }
  }
  return mesh;
}

Mesh make_waste_bin(Painter& painter) {
  const Surface shell = painter.plain({70, 76, 84}), inside = painter.plain({44, 46, 50});
  const Surface paper = painter.plain({236, 234, 226});
  Mesh mesh = make_lathe({{0, 0, shell},
                          {0.11, 0, shell},
                          {0.145, 0.3, shell},
                          {0.15, 0.302, shell},
                          {0.15, 0.312, shell},
                          {0.142, 0.312, inside},
                          {0.125, 0.16, inside},
                          {0, 0.16, inside}},
                         28);
  for (int i = 0; i < 4; ++i) {  // crumpled sheets
    mesh.append(
        make_tapered_box({{0.07, 0.06}, {0.05, 0.07}, 0.06, {0.01, -0.01}}, all_faces(paper)),
        placed(
            0.05 * std::cos(1.6 * i), 0.05 * std::sin(1.6 * i), 0.16 + 0.02 * (i % 2), 40.0 * i));
  }
  return mesh;
}

Mesh make_carton(Painter& painter, const Vector3d& size) {
  BoxSurfaces surfaces;
  for (std::size_t face = 0; face < 4; ++face) {
    const cv::Size2d extent(face < 2 ? size.y() : size.x(), size.z());
    surfaces[face] = painter.picture(carton_side_picture(extent, painter.next_seed()));
  }
  for (std::size_t face = 4; face < 6; ++face) {
    surfaces[face] = painter.picture(carton_top_picture({size.y(), size.x()}, painter.next_seed()));
  }
  return make_box(size, surfaces, {0.004});
}

Mesh make_plant(Painter& painter, double height, int leaves) {
  const Surface pot = painter.plain({190, 120, 88}), earth = painter.plain({70, 54, 42});
  const Surface stem = painter.plain({92, 92, 56});
  HashStream rng(painter.next_seed());
  const double scale = height / 0.9, r = 0.13 * scale, pot_height = 0.24 * scale;
  Mesh mesh = make_lathe({{0, 0, pot},
                          {0.75 * r, 0, pot},
                          {r, 0.85 * pot_height, pot},
                          {1.08 * r, 0.86 * pot_height, pot},
                          {1.08 * r, pot_height, pot},
                          {0.98 * r, pot_height, pot},
                          {0.94 * r, 0.88 * pot_height, earth},
                          {0, 0.9 * pot_height, earth}},
                         24);
  const double top = 0.72 * height;
  mesh.append(make_tube({{{0, 0, 0.8 * pot_height}, {0.01, 0.01, 0.5 * height}, {0, 0, top}},
                         0.014 * scale,
                         0.006 * scale},
                        stem,
                        8),
              placed(0, 0, 0));
  for (int i = 0; i < leaves; ++i) {
    const double share = (i + 0.5) / leaves;
    const Surface green = painter.plain(near_color({72, 112, 62}, 16, rng));
    const Leaf leaf{pot_height + share * (top - pot_height),
                    height * (0.06 + 0.2 * share),
                    0.3 * scale * (1.1 - 0.35 * share),
                    0.11 * scale,
                    2.4 * i};
    mesh.append(make_leaf(leaf, green), placed(0, 0, 0));
  }
  return mesh;
}

Mesh make_globe(Painter& painter, double radius) {
  const Surface metal = painter.plain({150, 126, 76}), foot = painter.plain({90, 62, 44});
  const cv::Size2d size(2.0 * std::numbers::pi * radius, std::numbers::pi * radius);
  const Surface map = painter.picture(world_map_picture(size, painter.next_seed()));
  std::vector<ProfilePoint> outline;
  constexpr int kSteps = 18;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    const bool pole = i == 0 || i == kSteps;
    outline.push_back({pole ? 0.0 : radius * std::sin(angle), -radius * std::cos(angle), map});
  }
  const double center = radius + 0.06;
  Mesh mesh = make_lathe({{0, 0, foot},
                          {0.6 * radius, 0, foot},
                          {0.6 * radius, 0.012, foot},
                          {0.015, 0.03, foot},
                          {0, 0.03, foot}},
                         24);
  Eigen::Isometry3d T = placed(0, 0, center);
  T.rotate(Eigen::AngleAxisd(0.4, Vector3d::UnitX()));
  mesh.append(make_lathe(outline, 36), T);
  Tube arc{{}, 0.006, 0.006};
  for (int i = 0; i <= 12; ++i) {  // from pole to pole
    const double angle = std::numbers::pi * (i / 12.0 + 0.5) + 0.4;
    arc.path.emplace_back(
        0, 1.06 * radius * std::cos(angle), center - 1.06 * radius * std::sin(angle));
  }
  mesh.append(make_tube(arc, metal, 8), placed(0, 0, 0));
  mesh.append(make_tube({{{0, 0, 0.025}, {0, 0, 0.056}}, 0.01, 0.008}, metal, 8), placed(0, 0, 0));
  return mesh;
}

Mesh make_coat_stand(Painter& painter) {
  const Surface wood = painter.plain({112, 80, 54});
  HashStream rng(painter.next_seed());
  const Paint tone = pick({{62, 70, 88}, {96, 64, 56}, {70, 84, 70}}, rng);
  const Surface cloth =
      painter.repeated(fabric_picture({0.12, 0.12}, tone, painter.next_seed()), 0.12);
  Mesh mesh = make_lathe(
      {{0, 0, wood}, {0.19, 0, wood}, {0.19, 0.02, wood}, {0.03, 0.05, wood}, {0, 0.05, wood}}, 28);
  mesh.append(make_tube({{{0, 0, 0.04}, {0, 0, 1.78}}, 0.02, 0.016}, wood), placed(0, 0, 0));
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.5 * std::numbers::pi * i + 0.3, c = std::cos(angle), s = std::sin(angle);
    mesh.append(
        make_tube(
            {{{0, 0, 1.62}, {0.08 * c, 0.08 * s, 1.64}, {0.13 * c, 0.13 * s, 1.72}}, 0.012, 0.01},
            wood,
            8),
        placed(0, 0, 0));
  }
  mesh.append(make_jacket(cloth), placed(0, 0, 0, 17.0));
  return mesh;
}

Mesh make_printer(Painter& painter) {
  const Surface body = painter.plain({214, 214, 210}), dark = painter.plain({62, 64, 68});
  BoxSurfaces paper = all_faces(painter.plain({244, 243, 238}));
  paper[4] = painter.picture(paper_picture({0.21, 0.297}, painter.next_seed()));
  BoxSurfaces panel = all_faces(dark);
  panel[4] = painter.picture(phone_picture({0.24, 0.1}, painter.next_seed()));
  Mesh mesh = make_box({0.38, 0.44, 0.2}, all_faces(body), {0.015, 2});
  mesh.append(make_box({0.3, 0.36, 0.06}, all_faces(dark), {0.01}), placed(0.03, 0, 0.2));
  mesh.append(make_box({0.1, 0.24, 0.012}, panel), placed(-0.13, 0.05, 0.2));
  mesh.append(make_box({0.02, 0.3, 0.05}, all_faces(dark)), placed(-0.185, 0, 0.1));
  mesh.append(make_box({0.16, 0.26, 0.008}, all_faces(dark)), placed(-0.25, 0, 0.07));
  mesh.append(make_box({0.297, 0.21, 0.004}, paper), placed(-0.17, 0, 0.08));
  return mesh;
}

}  // namespace stillmap
