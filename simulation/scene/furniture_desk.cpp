// SPDX-License-Identifier: Apache-2.0
// Functions of furniture.hpp: desks and the things on them.
#include <cmath>
#include <numbers>

#include "simulation/scene/canvas.hpp"
#include "simulation/scene/furniture.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPlusX = 0, kMinusX = 1, kPlusY = 2, kTop = 4;

BoxSurfaces with(const Surface& all, std::size_t face, const Surface& other) {
  BoxSurfaces surfaces = all_faces(all);
  surfaces[face] = other;
  return surfaces;
}

const std::vector<Paint> kCovers{{46, 74, 110},
                                 {142, 56, 48},
                                 {62, 100, 82},
                                 {196, 168, 110},
                                 {88, 82, 104},
                                 {216, 212, 200},
                                 {60, 62, 68},
                                 {186, 116, 66}};

// A drawer unit with its fronts towards -x.
Mesh make_drawers(Painter& painter) {
  const Surface body = painter.plain({206, 205, 200}), front = painter.plain({222, 221, 217});
  const Surface metal = painter.plain({120, 122, 126});
  Mesh mesh = make_box({0.55, 0.40, 0.56}, all_faces(body), {0.004});
  for (int i = 0; i < 3; ++i) {
    const double z = 0.02 + 0.18 * i;
    mesh.append(make_box({0.016, 0.384, 0.168}, all_faces(front), {0.003}), placed(-0.283, 0, z));
    const Tube grip{{{-0.291, -0.06, z + 0.13},
                     {-0.312, -0.055, z + 0.13},
                     {-0.312, 0.055, z + 0.13},
                     {-0.291, 0.06, z + 0.13}},
                    0.005,
                    0.005};
    mesh.append(make_tube(grip, metal, 6), Eigen::Isometry3d::Identity());
  }
  return mesh;
}

}  // namespace

Mesh make_desk(Painter& painter) {
  const Paint tone(190, 158, 116);
  const Surface edge = painter.plain({172, 140, 100}), metal = painter.plain({126, 129, 134});
  BoxSurfaces panel = all_faces(edge);
  for (const std::size_t face : {kPlusX, kMinusX}) {
    panel[face] = painter.picture(wood_picture({1.42, 0.36}, tone, painter.next_seed()));
  }
  BoxSurfaces top = all_faces(edge);
  top[kTop] = painter.picture(wood_picture({1.6, 0.8}, tone, painter.next_seed()));
  Mesh mesh;
  mesh.append(make_box({0.8, 1.6, 0.03}, top, {0.005}), placed(0, 0, kDeskHeight - 0.03));
  for (const double y : {-0.74, 0.74}) {
    mesh.append(make_box({0.7, 0.06, 0.03}, all_faces(metal), {0.004}), placed(0, y, 0.0));
    mesh.append(make_box({0.08, 0.04, 0.64}, all_faces(metal), {0.006}), placed(0.1, y, 0.03));
    mesh.append(make_box({0.6, 0.04, 0.03}, all_faces(metal), {0.004}), placed(0, y, 0.67));
  }
  mesh.append(make_box({0.018, 1.42, 0.36}, panel, {0.003}), placed(0.3, 0, 0.31));
  mesh.append(make_box({0.03, 1.44, 0.04}, all_faces(metal)), placed(0.1, 0, 0.655));
  mesh.append(make_drawers(painter), placed(0.0, -0.5, 0.04));
  return mesh;
}

Mesh make_monitor(Painter& painter, double width) {
  const double height = 0.59 * width, bottom = 0.12;
  const Surface plastic = painter.plain({44, 45, 48}), grey = painter.plain({70, 72, 76});
  const Surface screen =
      painter.glowing(screen_picture({width - 0.016, height - 0.024}, painter.next_seed()), 0.85F);
  const Surface badge = painter.plain({176, 178, 182});
  Mesh mesh;
  mesh.append(make_box({0.2, 0.26, 0.014}, all_faces(plastic), {0.006, 2}), placed(0.03, 0, 0));
  mesh.append(make_tapered_box({{0.05, 0.09}, {0.04, 0.06}, 0.24, {0.0, 0.0}}, all_faces(grey)),
              placed(0.055, 0, 0.012));
  mesh.append(make_box({0.03, width, height}, all_faces(plastic), {0.006, 2}),
              placed(0, 0, bottom));
  mesh.append(make_box({0.002, width - 0.016, height - 0.024}, with(plastic, kMinusX, screen)),
              placed(-0.0152, 0, bottom + 0.016));
  TaperedBox bulge{{height * 0.6, width * 0.6}, {height * 0.42, width * 0.46}, 0.03};
  Eigen::Isometry3d T = placed(0.014, 0, bottom + 0.5 * height);
  T.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
  mesh.append(make_tapered_box(bulge, all_faces(grey)), T);
  mesh.append(make_box({0.002, 0.07, 0.018}, all_faces(badge)),
              placed(0.0452, 0, bottom + 0.58 * height));
  for (int slot = 0; slot < 7; ++slot) {
    mesh.append(make_box({0.002, 0.4 * width, 0.003}, all_faces(plastic)),
                placed(0.0447, 0, bottom + 0.34 * height + 0.008 * slot));
  }
  const Tube cable{
      {{0.04, 0.02, bottom + 0.1}, {0.1, 0.03, 0.06}, {0.14, 0.02, 0.01}, {0.2, 0, 0.006}},
      0.004,
      0.004};
  mesh.append(make_tube(cable, plastic, 6), Eigen::Isometry3d::Identity());
  return mesh;
}

Mesh make_laptop(Painter& painter) {
  const Surface shell = painter.plain({172, 174, 178});
  const Surface keys = painter.picture(keyboard_picture({0.31, 0.21}, painter.next_seed()));
  const Surface screen = painter.glowing(screen_picture({0.3, 0.19}, painter.next_seed()), 0.85F);
  Mesh mesh = make_box({0.22, 0.32, 0.016}, with(shell, kTop, keys), {0.003});
  Mesh lid = make_box({0.008, 0.32, 0.215}, all_faces(shell), {0.003});
  lid.append(make_box({0.002, 0.3, 0.19}, with(shell, kMinusX, screen)), placed(-0.0045, 0, 0.014));
  Eigen::Isometry3d T = placed(0.108, 0, 0.012);
  T.rotate(Eigen::AngleAxisd(0.35, Vector3d::UnitY()));
  mesh.append(lid, T);
  return mesh;
}

Mesh make_keyboard(Painter& painter) {
  const Surface body = painter.plain({52, 53, 56});
  const Surface keys = painter.picture(keyboard_picture({0.44, 0.14}, painter.next_seed()));
  return make_box({0.14, 0.44, 0.02}, with(body, kTop, keys), {0.004});
}

Mesh make_mouse(Painter& painter) {
  const Surface shell = painter.plain({48, 49, 52}), wheel = painter.plain({150, 150, 152});
  Mesh mesh = make_box({0.108, 0.062, 0.036}, all_faces(shell), {0.0178, 4});
  mesh.append(make_box({0.02, 0.008, 0.012}, all_faces(wheel), {0.003}), placed(0.03, 0, 0.026));
  const Tube cable{{{0.05, 0, 0.008}, {0.12, 0.02, 0.004}, {0.2, 0.0, 0.004}}, 0.002, 0.002};
  mesh.append(make_tube(cable, shell, 6), Eigen::Isometry3d::Identity());
  return mesh;
}

Mesh make_phone(Painter& painter) {
  const Surface body = painter.plain({54, 56, 60});
  const Surface face = painter.picture(phone_picture({0.2, 0.2}, painter.next_seed()));
  Mesh mesh = make_box({0.2, 0.2, 0.045}, with(body, kTop, face), {0.008, 2});
  const Tube handset{
      {{-0.08, 0, 0}, {-0.05, 0, 0.012}, {0.05, 0, 0.012}, {0.08, 0, 0}}, 0.017, 0.017};
  mesh.append(make_tube(handset, body), placed(0.0, 0.065, 0.06));
  return mesh;
}

Mesh make_mug(Painter& painter) {
  HashStream rng(painter.next_seed());
  const Paint tone = pick({{238, 236, 230}, {226, 222, 208}, {206, 214, 218}}, rng);
  const Surface glaze = painter.plain(tone), tea = painter.plain({84, 56, 34});
  const Surface print = painter.picture(mug_picture({0.26, 0.09}, tone, painter.next_seed()));
  Mesh mesh = make_lathe({{0, 0, glaze},
                          {0.036, 0, glaze},
                          {0.041, 0.006, print},
                          {0.042, 0.094, glaze},
                          {0.040, 0.096, glaze},
                          {0.038, 0.094, glaze},
                          {0.037, 0.075, tea},
                          {0, 0.075, tea}},
                         28);
  Tube handle{{}, 0.0055, 0.0055};
  for (int i = 0; i <= 8; ++i) {
    const double angle = std::numbers::pi * (0.5 - i / 8.0);
    handle.path.emplace_back(0.039 + 0.03 * std::cos(angle), 0, 0.05 + 0.03 * std::sin(angle));
  }
  mesh.append(make_tube(handle, glaze, 8), Eigen::Isometry3d::Identity());
  return mesh;
}

Mesh make_bottle(Painter& painter) {
  const Surface glass = painter.plain({84, 128, 104}), cap = painter.plain({220, 220, 216});
  const Surface label =
      painter.picture(mug_picture({0.22, 0.08}, {232, 228, 210}, painter.next_seed()));
  return make_lathe({{0, 0, glass},
                     {0.034, 0, glass},
                     {0.036, 0.006, glass},
                     {0.036, 0.05, label},
                     {0.036, 0.13, glass},
                     {0.033, 0.16, glass},
                     {0.016, 0.2, glass},
                     {0.014, 0.225, cap},
                     {0.016, 0.226, cap},
                     {0.016, 0.245, cap},
                     {0, 0.246, cap}},
                    24);
}

Mesh make_pen_holder(Painter& painter) {
  const Surface cup = painter.plain({66, 70, 78}), dark = painter.plain({30, 30, 32});
  Mesh mesh = make_lathe({{0, 0, cup},
                          {0.038, 0, cup},
                          {0.04, 0.1, cup},
                          {0.037, 0.1, cup},
                          {0.035, 0.06, dark},
                          {0, 0.06, dark}},
                         20);
  const std::vector<Paint> tones{
      {200, 60, 50}, {50, 90, 160}, {226, 190, 80}, {40, 40, 44}, {70, 140, 90}};
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const double angle = 1.3 * static_cast<double>(i) + 0.4;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Tube pen{
        {0.012 * out + Vector3d(0, 0, 0.06), 0.045 * out + Vector3d(0, 0, 0.165)}, 0.004, 0.003};
    mesh.append(make_tube(pen, painter.plain(tones[i]), 6), Eigen::Isometry3d::Identity());
  }
  return mesh;
}

Mesh make_desk_lamp(Painter& painter) {
  const Surface metal = painter.plain({58, 62, 70}), bulb = painter.plain({246, 240, 222});
  Mesh mesh = make_lathe({{0, 0, metal},
                          {0.085, 0, metal},
                          {0.085, 0.012, metal},
                          {0.02, 0.024, metal},
                          {0, 0.024, metal}},
                         28);
  const Tube arm{{{0, 0, 0.02}, {0.05, 0, 0.26}, {-0.17, 0, 0.43}}, 0.008, 0.007};
  mesh.append(make_tube(arm, metal, 8), Eigen::Isometry3d::Identity());
  Eigen::Isometry3d T = placed(-0.17, 0, 0.44);
  T.rotate(Eigen::AngleAxisd(0.35, Vector3d::UnitY()));
  const Mesh shade = make_lathe({{0, -0.03, bulb},
                                 {0.03, -0.04, bulb},
                                 {0.03, -0.01, metal},
                                 {0.072, -0.062, metal},
                                 {0.076, -0.062, metal},
                                 {0.034, 0.012, metal},
                                 {0.014, 0.022, metal},
                                 {0, 0.022, metal}},
                                24);
  mesh.append(shade, T);
  return mesh;
}

Mesh make_papers(Painter& painter, int sheets) {
  const Surface blank = painter.plain({240, 239, 234});
  Mesh mesh;
  for (int i = 0; i < sheets; ++i) {
    const Surface page = painter.picture(paper_picture({0.21, 0.297}, painter.next_seed()));
    // Sheets beside or upon one another, each slightly turned.
    const double aside = 0.08 * std::sin(2.4 * i), ahead = 0.05 * std::sin(1.7 * i + 1.0);
    mesh.append(make_box({0.297, 0.21, 0.002}, with(blank, kTop, page)),
                placed(ahead, aside, 0.002 * i, 17.0 * std::sin(3.1 * i)));
  }
  return mesh;
}

Mesh make_book_stack(Painter& painter, int books) {
  Mesh mesh;
  HashStream rng(painter.next_seed());
  double z = 0;
  for (int i = 0; i < books; ++i) {
    const Paint tone = near_color(pick(kCovers, rng), 16, rng);
    const Surface plain = painter.plain(tone);
    const double height = 0.25 - 0.012 * i, width = 0.18 - 0.008 * ((3 * i) % 4);
    const double thick = 0.018 + 0.008 * ((5 * i) % 4);
    const Surface cover =
        painter.picture(book_cover_picture({width, height}, tone, painter.next_seed()));
    const Surface spine =
        painter.picture(book_cover_picture({height, thick}, tone, painter.next_seed()));
    const Surface pages = painter.picture(page_edges_picture({height, thick}, painter.next_seed()));
    Mesh book = make_box({height, width, 0.003}, all_faces(plain));
    book.append(make_box({height - 0.008, width - 0.006, thick - 0.006}, all_faces(pages)),
                placed(0, 0.002, 0.003));
    book.append(make_box({height, width, 0.003}, with(plain, kTop, cover)),
                placed(0, 0, thick - 0.003));
    book.append(make_box({height, 0.003, thick}, with(plain, kPlusY, spine)),
                placed(0, 0.5 * width + 0.0015, 0));
    mesh.append(
        book,
        placed(0.01 * std::sin(2.0 * i), 0.01 * std::cos(3.0 * i), z, 14.0 * std::sin(2.3 * i)));
    z += thick;
  }
  return mesh;
}

}  // namespace stillmap
