// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/office.hpp"

#include <map>

#include "simulation/scene/furniture.hpp"

namespace stillmap {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kHalf = 3.0;  // of the room's sides
constexpr double kHeight = 2.7;

class OfficeBuilder {
 public:
  OfficeBuilder(std::uint32_t seed, const Assets* assets) : painter_(seed), assets_(assets) {}

  World build() {
    add_room();
    add_lamps();
    add_east_wall();
    add_north_wall();
    add_west_wall();
    add_south_wall();
    add_first_desk(placed(1.75, 0.95, 0, 0));
    add_second_desk(placed(1.75, -0.95, 0, 180));
    add_third_desk(placed(-1.75, -1.9, 0, -90));
    add_movables();
    add_floor_things();
    world_.ambient = 0.5;
    world_.materials = painter_.take_materials();
    replace_chairs();
    return std::move(world_);
  }

 private:
  // Names are the class, or `name` where given, and a number.
  void add(const std::string& class_name, Mesh mesh, const Isometry3d& T, std::string name = "") {
    if (name.empty()) name = class_name;
    for (char& c : name) c = c == ' ' ? '_' : c;
    const int number = ++numbers_[name];
    world_.things.push_back(
        {name + "_" + std::to_string(number), class_name, 0, std::move(mesh), T});
  }

  void add_movable(const std::string& name,
                   const std::string& class_name,
                   std::uint8_t id,
                   Mesh mesh,
                   const Isometry3d& T) {
    world_.things.push_back({name, class_name, id, std::move(mesh), T});
  }

  // A frame on a wall: x into the wall, y to the left as seen from inside, z up from the floor.
  // `along` is the world's x or y of the place.
  static Isometry3d on_east(double along, double z) { return placed(kHalf, along, z, 0); }
  static Isometry3d on_north(double along, double z) { return placed(along, kHalf, z, 90); }
  static Isometry3d on_west(double along, double z) { return placed(-kHalf, along, z, 180); }
  static Isometry3d on_south(double along, double z) { return placed(along, -kHalf, z, -90); }

  Mesh framed_landscape(cv::Size2d size, const cv::Vec3b& frame) {
    const Surface picture = painter_.picture(landscape_picture(size, painter_.next_seed()));
    return make_framed(painter_, size, picture, frame);
  }
  Mesh framed_abstract(cv::Size2d size, const cv::Vec3b& frame) {
    const Surface picture = painter_.picture(abstract_picture(size, painter_.next_seed()));
    return make_framed(painter_, size, picture, frame);
  }
  Mesh science_poster(cv::Size2d size) {
    const Surface picture = painter_.picture(science_poster_picture(size, painter_.next_seed()));
    return make_sheet_on_wall(painter_, size, picture);
  }
  Mesh calendar(cv::Size2d size) {
    const Surface picture = painter_.picture(calendar_picture(size, painter_.next_seed()));
    return make_sheet_on_wall(painter_, size, picture);
  }
  Mesh socket(int places) {
    const cv::Size2d size(0.08 * places, 0.08);
    const Surface picture = painter_.picture(socket_picture(size, painter_.next_seed()));
    return make_sheet_on_wall(painter_, size, picture);
  }

  void add_room();
  void add_lamps();
  void add_east_wall();
  void add_north_wall();
  void add_west_wall();
  void add_south_wall();
  void add_first_desk(const Isometry3d& T_world_desk);
  void add_second_desk(const Isometry3d& T_world_desk);
  void add_third_desk(const Isometry3d& T_world_desk);
  void add_movables();
  void replace_chairs();
  void add_floor_things();
  void add_low_shelf(const Isometry3d& T_world_shelf);

  Painter painter_;
  const Assets* assets_;  // may be null
  World world_;
  std::map<std::string, int> numbers_;
};

void OfficeBuilder::add_room() {
  const double side = 2 * kHalf;
  const Surface grey = painter_.plain({120, 120, 120});
  BoxSurfaces floor = all_faces(grey), ceiling = all_faces(grey);
  floor[4] = painter_.picture(carpet_picture({side, side}, painter_.next_seed()));
  ceiling[5] = painter_.picture(ceiling_picture({side, side}, painter_.next_seed()));
  add("floor", make_box({side, side, 0.1}, floor), placed(0, 0, -0.1));
  add("ceiling", make_box({side, side, 0.1}, ceiling), placed(0, 0, kHeight));
  for (const Isometry3d& T : {on_east(0, 0), on_north(0, 0), on_west(0, 0), on_south(0, 0)}) {
    add("wall", make_wall(painter_, {side, kHeight}), T);
  }
}

void OfficeBuilder::add_lamps() {
  const Surface metal = painter_.plain({210, 210, 208});
  constexpr double kDrop = 0.04;
  for (const Vector3d& center :
       {Vector3d(1.5, 0.0, 0), Vector3d(-1.2, 1.5, 0), Vector3d(-1.2, -1.5, 0)}) {
    const cv::Size2d size(1.2, 0.3);
    BoxSurfaces panel = all_faces(metal);
    panel[5] = painter_.glowing(lamp_panel_picture(size, painter_.next_seed()), 1.F);
    add("lamp",
        make_box({0.3, 1.2, kDrop}, panel, {0.004}),
        placed(center.x(), center.y(), kHeight - kDrop),
        "ceiling_lamp");
    AreaLamp lamp;
    lamp.center_world = Vector3d(center.x(), center.y(), kHeight - kDrop - 0.005);
    lamp.half_u_world = Vector3d(0.15, 0, 0);
    lamp.half_v_world = Vector3d(0, 0.6, 0);
    lamp.power = 2.4;
    world_.lamps.push_back(lamp);
  }
}

// Before the camera of most sequences: board and map, and a blank stretch beyond y = 1.5.
void OfficeBuilder::add_east_wall() {
  add("whiteboard", make_whiteboard(painter_, {1.3, 0.95}), on_east(-0.95, 0.98));
  const cv::Size2d map_size(1.15, 0.75);
  const Surface map = painter_.picture(world_map_picture(map_size, painter_.next_seed()));
  add("poster", make_framed(painter_, map_size, map, {70, 60, 52}), on_east(0.55, 1.1));
  add("poster", calendar({0.26, 0.4}), on_east(1.36, 1.25), "calendar");
  const Surface face = painter_.picture(clock_picture({0.26, 0.26}, painter_.next_seed()));
  add("clock", make_framed(painter_, {0.3, 0.3}, face, {40, 42, 46}), on_east(-0.02, 2.05));
  add("socket", socket(3), on_east(0.4, 0.28));
  add("poster", framed_landscape({0.5, 0.4}, {120, 90, 60}), on_east(-2.2, 1.3), "picture");
}

void OfficeBuilder::add_north_wall() {
  add("window", make_window(painter_, {1.6, 1.25}), on_north(-1.55, 0.95));
  add("radiator", make_radiator(painter_, 1.3), on_north(-1.55, 0.0));
  add("poster", science_poster({0.6, 0.85}), on_north(1.75, 1.05));
  add("socket", socket(2), on_north(1.6, 0.28));
  add("poster", framed_abstract({0.45, 0.6}, {36, 36, 38}), on_north(-0.4, 1.3), "picture");
}

void OfficeBuilder::add_west_wall() {
  add("door", make_door(painter_, {0.9, 2.02}), on_west(1.3, 0));
  add("switch", socket(1), on_west(0.66, 1.08));
  const cv::Size2d size(1.2, 0.8);
  const Surface board = painter_.picture(pinboard_picture(size, painter_.next_seed()));
  add("pinboard", make_framed(painter_, size, board, {150, 116, 76}), on_west(-0.3, 1.1));
  add("poster", science_poster({0.5, 0.7}), on_west(-1.5, 1.15));
}

// Blank from x = -2.9 to -1.3, except for a calendar.
void OfficeBuilder::add_south_wall() {
  add("poster", framed_landscape({0.9, 0.6}, {44, 44, 46}), on_south(-0.35, 1.25), "picture");
  add("poster", science_poster({0.7, 1.0}), on_south(0.45, 0.95));
  add("poster", framed_abstract({0.55, 0.7}, {196, 170, 130}), on_south(1.25, 1.35), "picture");
  add("poster", framed_landscape({0.4, 0.5}, {230, 228, 222}), on_south(2.0, 1.4), "picture");
  add("socket", socket(3), on_south(-0.9, 0.28));
}

void OfficeBuilder::add_first_desk(const Isometry3d& T_world_desk) {
  const Isometry3d T_world_top = T_world_desk * placed(0, 0, kDeskHeight);
  add("dining table", make_desk(painter_), T_world_desk, "desk");
  add("tv", make_monitor(painter_, 0.56), T_world_top * placed(0.16, 0.06, 0, 2), "monitor");
  add("tv", make_monitor(painter_, 0.5), T_world_top * placed(0.14, -0.5, 0, -16), "monitor");
  add("keyboard", make_keyboard(painter_), T_world_top * placed(-0.2, 0.02, 0, 2));
  add("mouse", make_mouse(painter_), T_world_top * placed(-0.2, -0.29, 0, -6));
  add("cup", make_mug(painter_), T_world_top * placed(-0.08, 0.4, 0, 120));
  add("book", make_book_stack(painter_, 4), T_world_top * placed(0.16, 0.58, 0, 12));
  add("paper", make_papers(painter_, 4), T_world_top * placed(-0.18, 0.57, 0, 6), "papers");
  add("telephone", make_phone(painter_), T_world_top * placed(-0.12, -0.64, 0, -20));
  add("pen holder", make_pen_holder(painter_), T_world_top * placed(0.02, 0.36, 0, 0));
  add("bottle", make_bottle(painter_), T_world_top * placed(0.3, -0.74, 0, 40));
}

void OfficeBuilder::add_second_desk(const Isometry3d& T_world_desk) {
  const Isometry3d T_world_top = T_world_desk * placed(0, 0, kDeskHeight);
  add("dining table", make_desk(painter_), T_world_desk, "desk");
  add("tv", make_monitor(painter_, 0.54), T_world_top * placed(0.1, 0.0, 0, 0), "monitor");
  add("keyboard", make_keyboard(painter_), T_world_top * placed(-0.22, 0.0, 0, -3));
  add("mouse", make_mouse(painter_), T_world_top * placed(-0.2, -0.32, 0, 8));
  add("book", make_book_stack(painter_, 5), T_world_top * placed(0.18, 0.52, 0, -75));
  add("cup", make_mug(painter_), T_world_top * placed(0.22, 0.33, 0, -60));
  add("cup", make_mug(painter_), T_world_top * placed(-0.1, 0.38, 0, 200));
  add("potted plant", make_plant(painter_, 0.36, 16), T_world_top * placed(0.24, -0.42, 0, 0));
  add("lamp", make_desk_lamp(painter_), T_world_top * placed(0.24, -0.66, 0, 15), "desk_lamp");
  add("paper", make_papers(painter_, 5), T_world_top * placed(-0.12, 0.6, 0, -8), "papers");
  add("book", make_book_stack(painter_, 2), T_world_top * placed(-0.15, -0.6, 0, 20));
}

void OfficeBuilder::add_third_desk(const Isometry3d& T_world_desk) {
  const Isometry3d T_world_top = T_world_desk * placed(0, 0, kDeskHeight);
  add("dining table", make_desk(painter_), T_world_desk, "desk");
  add("tv", make_monitor(painter_, 0.6), T_world_top * placed(0.14, 0.25, 0, 8), "monitor");
  add("keyboard", make_keyboard(painter_), T_world_top * placed(-0.2, 0.2, 0, 5));
  add("mouse", make_mouse(painter_), T_world_top * placed(-0.2, -0.1, 0, 0));
  add("laptop", make_laptop(painter_), T_world_top * placed(0.05, -0.45, 0, -18));
  add("book", make_book_stack(painter_, 6), T_world_top * placed(0.2, -0.08, 0, 30));
  add("paper", make_papers(painter_, 6), T_world_top * placed(-0.15, 0.58, 0, 4), "papers");
  add("cup", make_mug(painter_), T_world_top * placed(-0.1, -0.68, 0, 70));
  add("lamp", make_desk_lamp(painter_), T_world_top * placed(0.26, 0.68, 0, -10), "desk_lamp");
  add("pen holder", make_pen_holder(painter_), T_world_top * placed(0.28, -0.3, 0, 50));
}

void OfficeBuilder::add_movables() {
  add_movable(
      "chair_1", "chair", 10, make_chair(painter_, {58, 72, 98}, false), placed(1.15, 0.95, 0, 0));
  add_movable("chair_2",
              "chair",
              11,
              make_chair(painter_, {104, 58, 56}, true),
              placed(2.35, -0.95, 0, 180));
  add_movable(
      "chair_3", "chair", 12, make_chair(painter_, {74, 92, 80}, true), placed(0.85, -1.95, 0, 90));
  add_movable(
      "box_1", "box", 13, make_carton(painter_, {0.40, 0.32, 0.30}), placed(1.2, -2.66, 0.75, 0));
}

// Uses the models in turn.
void OfficeBuilder::replace_chairs() {
  if (assets_ == nullptr || assets_->chairs.empty()) return;
  std::size_t next = 0;
  for (Thing& thing : world_.things) {
    if (thing.class_name != "chair") continue;
    const AssetModel& chair = assets_->chairs[next++ % assets_->chairs.size()];
    thing.mesh = add_model(chair, world_.materials);
  }
}

void OfficeBuilder::add_floor_things() {
  const ShelfSize size;
  const Isometry3d T_world_shelf = placed(0.6, 2.82, 0, 0);
  const auto board = [&](int i) { return 0.085 + (size.height - 0.09) / (size.boards - 1) * i; };
  add("shelf", make_shelf(painter_, size), T_world_shelf);
  add("book",
      make_binder_row(painter_, 11),
      T_world_shelf * placed(-0.64, 0.0, board(0)),
      "binders");
  for (int i = 1; i < 4; ++i) {
    const double length = i == 2 ? 0.85 : 1.25;
    add("book",
        make_book_row(painter_, length, 77U + static_cast<unsigned>(i)),
        T_world_shelf * placed(-0.65, 0.0, board(i)),
        "books");
  }
  add("vase", make_bottle(painter_), T_world_shelf * placed(0.35, 0, board(2), 30));
  add("potted plant",
      make_plant(painter_, 0.3, 12),
      T_world_shelf * placed(0.54, -0.02, board(2), 0));
  add("box",
      make_carton(painter_, {0.34, 0.26, 0.2}),
      T_world_shelf * placed(-0.45, 0, board(4), 4),
      "archive_box");
  add("box",
      make_carton(painter_, {0.3, 0.24, 0.16}),
      T_world_shelf * placed(-0.05, 0.01, board(4), -5),
      "archive_box");
  add("book", make_book_stack(painter_, 5), T_world_shelf * placed(0.42, 0, board(4), 70));
  add_low_shelf(placed(-0.15, -2.83, 0, 180));
  add("cabinet", make_cabinet(painter_, {0.45, 0.8, 0.75}), placed(1.2, -2.72, 0, -90));
  add("cabinet", make_cabinet(painter_, {0.45, 0.9, 0.8}), placed(-2.74, -0.3, 0, 180));
  add("printer", make_printer(painter_), placed(-2.72, -0.15, 0.8, 180));
  add("book", make_book_stack(painter_, 3), placed(-2.72, -0.58, 0.8, 200));
  add("table", make_side_table(painter_, {0.5, 0.5, 0.6}), placed(2.55, 2.3, 0, 0), "side_table");
  add("trash can", make_waste_bin(painter_), placed(1.95, 0.28, 0, 0));
  add("trash can", make_waste_bin(painter_), placed(-0.72, -2.1, 0, 0));
  add("potted plant", make_plant(painter_, 1.25, 30), placed(2.55, -2.6, 0, 20));
  add("coat stand", make_coat_stand(painter_), placed(-2.62, 2.3, 0, -40));
}

void OfficeBuilder::add_low_shelf(const Isometry3d& T_world_shelf) {
  const ShelfSize size{0.84, 0.3, 0.82, 3};
  add("shelf", make_shelf(painter_, size), T_world_shelf);
  add("book",
      make_book_row(painter_, 0.72, 91),
      T_world_shelf * placed(-0.38, 0.0, 0.085),
      "books");
  add("book", make_book_row(painter_, 0.5, 92), T_world_shelf * placed(-0.38, 0.0, 0.45), "books");
  add("cup", make_mug(painter_), T_world_shelf * placed(0.3, 0, 0.45, 60));
  add("globe", make_globe(painter_, 0.13), T_world_shelf * placed(0.22, 0, 0.815, 0));
  add("book", make_book_stack(painter_, 3), T_world_shelf * placed(-0.22, 0, 0.815, 80));
}

}  // namespace

World make_office(std::uint32_t seed, const Assets* assets) {
  return OfficeBuilder(seed, assets).build();
}

}  // namespace stillmap
