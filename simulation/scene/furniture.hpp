// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/scene/painter.hpp"

namespace stillmap {

/// Furniture and objects of an office. Each mesh stands on z = 0 of its own frame.

// For desks: their user is on the -x side and looks at +x. Screens, keys and covers face the user.
[[nodiscard]] Mesh make_desk(Painter& painter);  ///< top 1.6 (y) x 0.8 (x), upper side at z = 0.73
inline constexpr double kDeskHeight = 0.73;
[[nodiscard]] Mesh make_monitor(Painter& painter, double width);
[[nodiscard]] Mesh make_laptop(Painter& painter);
[[nodiscard]] Mesh make_keyboard(Painter& painter);
[[nodiscard]] Mesh make_mouse(Painter& painter);
[[nodiscard]] Mesh make_phone(Painter& painter);
[[nodiscard]] Mesh make_mug(Painter& painter);
[[nodiscard]] Mesh make_bottle(Painter& painter);
[[nodiscard]] Mesh make_pen_holder(Painter& painter);
[[nodiscard]] Mesh make_desk_lamp(Painter& painter);
[[nodiscard]] Mesh make_papers(Painter& painter, int sheets);
[[nodiscard]] Mesh make_book_stack(Painter& painter, int books);  ///< lying on one another

// On the floor.
/// The sitter looks at +x; the seat's top is at z = 0.46, the back at x = -0.22 reaches z = 0.92.
[[nodiscard]] Mesh make_chair(Painter& painter, const cv::Vec3b& tone, bool armrests);
/// Open to -y, its back at y = depth / 2.
struct ShelfSize {
  double width = 1.4, depth = 0.32, height = 1.9;
  int boards = 5;
};
[[nodiscard]] Mesh make_shelf(Painter& painter, const ShelfSize& size);
/// Books and binders for one board of a shelf; spines towards -y, the row begins at x = 0.
[[nodiscard]] Mesh make_book_row(Painter& painter, double length, std::uint64_t layout_seed);
[[nodiscard]] Mesh make_binder_row(Painter& painter, int binders);
/// Doors towards -x.
[[nodiscard]] Mesh make_cabinet(Painter& painter, const Eigen::Vector3d& size);
[[nodiscard]] Mesh make_side_table(Painter& painter, const Eigen::Vector3d& size);
[[nodiscard]] Mesh make_waste_bin(Painter& painter);
[[nodiscard]] Mesh make_carton(Painter& painter, const Eigen::Vector3d& size);
[[nodiscard]] Mesh make_plant(Painter& painter, double height, int leaves);
[[nodiscard]] Mesh make_globe(Painter& painter, double radius);
[[nodiscard]] Mesh make_coat_stand(Painter& painter);
[[nodiscard]] Mesh make_printer(Painter& painter);  ///< its front towards -x

// On walls: the back is at x = 0, the front faces -x; z = 0 is the lower edge.
[[nodiscard]] Mesh make_framed(Painter& painter,
                               cv::Size2d size,
                               const Surface& picture,
                               const cv::Vec3b& frame);
[[nodiscard]] Mesh make_sheet_on_wall(Painter& painter, cv::Size2d size, const Surface& picture);
[[nodiscard]] Mesh make_whiteboard(Painter& painter, cv::Size2d size);
[[nodiscard]] Mesh make_window(Painter& painter, cv::Size2d size);
[[nodiscard]] Mesh make_door(Painter& painter, cv::Size2d size);
[[nodiscard]] Mesh make_radiator(Painter& painter, double width);
/// A wall seen from its -x side, with a skirting board.
[[nodiscard]] Mesh make_wall(Painter& painter, cv::Size2d size);

}  // namespace stillmap
