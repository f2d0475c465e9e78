// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/scene.hpp"

#include <numbers>

#include "stillmap/scene/hash_random.hpp"
#include "stillmap/scene/paint.hpp"
#include "stillmap/synth/slab.hpp"

namespace stillmap {
namespace {

constexpr double kObjectTexel = 0.0025;  // metres
constexpr double kHiddenTexel = 0.02;    // faces nobody looks at
constexpr double kWallTexel = 0.004;
constexpr double kFloorTexel = 0.004;
constexpr double kCeilingTexel = 0.01;

Eigen::Isometry3d placed(double x, double y, double z, double yaw_deg) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::AngleAxisd(yaw_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ()).matrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

class RoomBuilder {
 public:
  explicit RoomBuilder(std::uint32_t seed) : seed_(seed) {}

  // The room's own box, its floor at z = 0.
  void add_room(const Eigen::Vector3d& size) {
    SceneBox room;
    room.T_world_box = placed(0, 0, 0.5 * size.z(), 0);
    room.half_size = 0.5 * size;
    room.seen_from_inside = true;
    room.textures = {add_texture(Paint::kWall, size.y(), size.z(), kWallTexel),
                     add_texture(Paint::kWall, size.y(), size.z(), kWallTexel),
                     add_texture(Paint::kWall, size.x(), size.z(), kWallTexel),
                     add_texture(Paint::kBareWall, size.x(), size.z(), kWallTexel),
                     add_texture(Paint::kFloor, size.x(), size.y(), kFloorTexel),
                     add_texture(Paint::kCeiling, size.x(), size.y(), kCeilingTexel)};
    scene_.boxes.push_back(room);
  }

  // A box of the given size that stands on z = `bottom` of the frame T_world_parent.
  void add_box(const Eigen::Isometry3d& T_world_parent,
               const Eigen::Isometry3d& T_parent_bottom,
               const Eigen::Vector3d& size,
               Paint kind) {
    SceneBox box;
    box.T_world_box = T_world_parent * T_parent_bottom * placed(0, 0, 0.5 * size.z(), 0);
    box.half_size = 0.5 * size;
    for (int face = 0; face < 6; ++face) {
      const FaceAxes axes = face_axes(face);
      const bool underside = face == 4;
      // Only a row of books seen from the front shows spines; its top and ends are printed.
      const bool front = kind != Paint::kSpines || axes.normal == 1;
      box.textures[static_cast<std::size_t>(face)] =
          add_texture(front ? kind : Paint::kPrinted,
                      size[axes.column],
                      size[axes.row],
                      underside ? kHiddenTexel : kObjectTexel);
    }
    scene_.boxes.push_back(box);
  }

  void add_desk(const Eigen::Isometry3d& T_world_desk);
  void add_desk_things(const Eigen::Isometry3d& T_world_desk);
  void add_shelf(const Eigen::Isometry3d& T_world_shelf);

  Scene finish() { return std::move(scene_); }

 private:
  std::size_t add_texture(Paint kind, double width_m, double height_m, double texel_m) {
    const std::uint64_t key = (std::uint64_t{seed_} << 32U) | scene_.textures.size();
    scene_.textures.emplace_back(paint(kind, width_m, height_m, texel_m, mix_bits(key)));
    return scene_.textures.size() - 1;
  }

  std::uint32_t seed_;
  Scene scene_{{}, {}, {0.4, -0.6, 2.5}, 0.5};
};

constexpr double kDeskHeight = 0.73;
constexpr double kDeskDepth = 0.8;
constexpr double kDeskWidth = 1.6;

// A desk whose user sits on its -y side.
void RoomBuilder::add_desk(const Eigen::Isometry3d& T_world_desk) {
  constexpr double kTop = 0.03;
  add_box(T_world_desk,
          placed(0, 0, kDeskHeight - kTop, 0),
          {kDeskWidth, kDeskDepth, kTop},
          Paint::kWood);
  for (const double side : {-1.0, 1.0}) {
    add_box(T_world_desk,
            placed(side * (0.5 * kDeskWidth - 0.05), 0, 0, 0),
            {0.04, kDeskDepth - 0.1, kDeskHeight - kTop},
            Paint::kPrinted);
  }
  add_box(T_world_desk,
          placed(0, 0.5 * kDeskDepth - 0.06, 0.25, 0),
          {kDeskWidth - 0.14, 0.02, 0.3},
          Paint::kPrinted);
}

void RoomBuilder::add_desk_things(const Eigen::Isometry3d& T_world_desk) {
  const Eigen::Isometry3d T_world_top = T_world_desk * placed(0, 0, kDeskHeight, 0);
  add_box(T_world_top, placed(-0.3, 0.2, 0, 0), {0.24, 0.16, 0.12}, Paint::kPrinted);  // stand
  add_box(T_world_top, placed(-0.3, 0.2, 0.12, 8), {0.52, 0.05, 0.34}, Paint::kPrinted);
  add_box(T_world_top, placed(0.35, 0.15, 0, -25), {0.3, 0.22, 0.25}, Paint::kPrinted);
  add_box(T_world_top, placed(0.38, 0.13, 0.25, 20), {0.2, 0.15, 0.1}, Paint::kPrinted);
  add_box(T_world_top, placed(0.62, -0.15, 0, 40), {0.16, 0.22, 0.05}, Paint::kPrinted);
  add_box(T_world_top, placed(0.05, -0.18, 0, 12), {0.22, 0.28, 0.035}, Paint::kPrinted);
  add_box(T_world_top, placed(-0.62, -0.12, 0, -15), {0.12, 0.12, 0.18}, Paint::kPrinted);
}

// A shelf with its back on +y, open to -y.
void RoomBuilder::add_shelf(const Eigen::Isometry3d& T_world_shelf) {
  constexpr double kWidth = 1.4, kHeight = 1.9, kDepth = 0.35;
  add_box(T_world_shelf, placed(0, 0.5 * kDepth, 0, 0), {kWidth, 0.02, kHeight}, Paint::kWood);
  for (const double side : {-1.0, 1.0}) {
    add_box(
        T_world_shelf, placed(side * 0.5 * kWidth, 0, 0, 0), {0.03, kDepth, kHeight}, Paint::kWood);
  }
  for (int board = 0; board < 5; ++board) {
    const double z = 0.06 + 0.42 * board;
    add_box(T_world_shelf, placed(0, 0, z, 0), {kWidth - 0.03, kDepth, 0.025}, Paint::kWood);
    if (board == 4) continue;  // the top board stays empty
    const double start = board % 2 == 0 ? -0.25 : 0.2;
    add_box(T_world_shelf,
            placed(start, 0.03, z + 0.025, 0),
            {0.75, 0.22, 0.24 + 0.03 * board},
            Paint::kSpines);
  }
}

}  // namespace

std::optional<SceneHit> first_hit(const Scene& scene,
                                  const Eigen::Vector3d& origin_world,
                                  const Eigen::Vector3d& direction_world) {
  std::optional<SceneHit> nearest;
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
    const SceneBox& box = scene.boxes[i];
    const Eigen::Isometry3d T_box_world = box.T_world_box.inverse();
    const SlabHit hit = intersect_slabs(T_box_world * origin_world,
                                        T_box_world.linear() * direction_world,
                                        box.half_size,
                                        box.seen_from_inside);
    if (std::isfinite(hit.t) && (!nearest || hit.t < nearest->t)) {
      nearest = SceneHit{i, hit.face, hit.t};
    }
  }
  return nearest;
}

Scene make_room(std::uint32_t seed) {
  RoomBuilder builder(seed);
  builder.add_room({6.0, 6.0, 2.7});
  for (const Eigen::Isometry3d& T_world_desk : {placed(1.3, 0.5, 0, -90),  // in front of +x
                                                placed(2.2, -1.4, 0, -80),
                                                placed(-1.6, -1.7, 0, 170)}) {  // towards -y
    builder.add_desk(T_world_desk);
    builder.add_desk_things(T_world_desk);
  }
  builder.add_shelf(placed(-0.4, 2.75, 0, 0));
  builder.add_box(placed(1.9, 2.3, 0, 0), placed(0, 0, 0, 30), {0.6, 0.5, 0.8}, Paint::kPrinted);
  builder.add_box(placed(1.9, 2.3, 0, 0), placed(0, 0, 0.8, 5), {0.4, 0.4, 0.4}, Paint::kPrinted);
  builder.add_box(placed(-2.5, 0.8, 0, 0), placed(0, 0, 0, -20), {0.5, 0.9, 1.1}, Paint::kPrinted);
  builder.add_box(placed(-2.3, 2.2, 0, 0), placed(0, 0, 0, 50), {0.5, 0.5, 0.5}, Paint::kPrinted);
  return builder.finish();
}

}  // namespace stillmap
