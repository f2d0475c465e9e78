// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/commands.hpp"
#include "apps/picture_size.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/input_files.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/map_files.hpp"
#include "tooling/export/surface_mesh.hpp"
#include "tooling/report/map_views.hpp"

namespace stillmap {
namespace {

struct ViewArguments {
  std::vector<std::string> maps;
  std::vector<std::string> names;
  std::string out;
  std::string from = "all";
  std::string size = "640x480";
  std::string groundtruth;
  std::string up;  ///< empty: to be found
  bool surface = false;
  double cell_m = MeshOptions{}.cell_m;
};

struct NamedSide {
  std::string_view name;
  MapSide side;
};
constexpr std::array<NamedSide, 3> kSides = {
    {{"front", MapSide::kFront}, {"left", MapSide::kLeft}, {"top", MapSide::kTop}}};

std::vector<NamedSide> chosen_sides(const std::string& from) {
  std::vector<std::string> names = {"all"};
  std::vector<NamedSide> sides;
  for (const NamedSide& side : kSides) {
    names.emplace_back(side.name);
    if (from == "all" || from == side.name) sides.push_back(side);
  }
  if (sides.empty()) throw Error("--from {}: {}", from, name_hint(from, names));
  return sides;
}

struct PosedMap {
  PointCloud cloud;
  Trajectory cameras;  ///< trajectory of the run; empty if there is none beside the map
};

PosedMap read_posed_map(const std::string& file) {
  PosedMap map{.cloud = read_map(file), .cameras = {}};
  if (map.cloud.empty()) throw Error("{}: no points, nothing to see", file);
  const std::filesystem::path trajectory =
      std::filesystem::path(file).parent_path() / "trajectory.txt";
  if (std::filesystem::exists(trajectory)) map.cameras = read_trajectory(trajectory);
  return map;
}

// Moves the map to the coordinate frame of the ground truth, in which maps without a run are.
PosedMap in_truth(PosedMap map, const Trajectory& groundtruth, const std::string& file) {
  if (map.cameras.empty()) {
    map.cameras = groundtruth;
    return map;
  }
  const std::optional<Eigen::Isometry3d> T = map_alignment(groundtruth, map.cameras);
  if (!T) throw Error("{}: fewer than 3 poses of its run have ground truth", file);
  map.cloud = moved(std::move(map.cloud), *T);
  for (StampedPose& pose : map.cameras) pose.T_world_camera = *T * pose.T_world_camera;
  return map;
}

std::vector<PosedMap> read_maps(const ViewArguments& arguments) {
  Trajectory groundtruth;
  if (!arguments.groundtruth.empty()) groundtruth = read_trajectory(arguments.groundtruth);
  std::vector<PosedMap> maps;
  for (const std::string& file : arguments.maps) {
    maps.push_back(read_posed_map(file));
    if (!groundtruth.empty()) maps.back() = in_truth(std::move(maps.back()), groundtruth, file);
  }
  return maps;
}

// The axis that points up from a text such as "z" or "-y"; nothing for an empty text.
std::optional<Eigen::Vector3d> up_axis(const std::string& name) {
  if (name.empty()) return std::nullopt;
  const double sign = name.front() == '-' ? -1.0 : 1.0;
  return sign * Eigen::Vector3d::Unit(name.back() - 'x');
}

std::string caption(const ViewArguments& arguments, std::size_t map, std::string_view side) {
  std::string text = map < arguments.names.size() ? arguments.names[map] : "";
  if (text.empty()) return std::string(side);
  return fmt::format("{}, {}", text, side);
}

// JPEG for a file name of JPEG, else PNG.
std::string encoded(const ColorImage& picture, const std::string& file) {
  constexpr int kQuality = 85;
  if (!file.ends_with(".jpg") && !file.ends_with(".jpeg")) return encode_png(picture);
  const std::vector<std::uint8_t> bytes = encode_jpeg(picture, kQuality);
  return std::string(bytes.begin(), bytes.end());
}

// The map's points without triangles, or its surface.
SurfaceMesh what_is_drawn(const ViewArguments& arguments, std::size_t map, PointCloud cut) {
  if (!arguments.surface) return {.vertices = std::move(cut), .triangles = {}};
  const std::string& file = arguments.maps[map];
  if (cut.normals.empty()) {
    throw Error("{}: --surface needs points with normals, as the maps of runs have them", file);
  }
  SurfaceMesh mesh;
  try {
    mesh = surface_mesh(cut, {.cell_m = arguments.cell_m});
  } catch (const Error& error) {
    throw Error("{}: --mesh-cell {}: {}", file, arguments.cell_m, error.what());
  }
  if (mesh.triangles.empty())
    throw Error("{}: too few points for a surface; see --mesh-cell", file);
  return mesh;
}

void view(const ViewArguments& arguments) {
  const std::vector<NamedSide> sides = chosen_sides(arguments.from);
  const PictureSize size = parse_picture_size(arguments.size);
  InputFiles inputs;
  for (const std::string& map : arguments.maps) {
    inputs.add(map);
    inputs.add(std::filesystem::path(map).parent_path() / "trajectory.txt");
  }
  inputs.add(arguments.groundtruth);
  inputs.check_output("--out", arguments.out);
  const std::vector<PosedMap> maps = read_maps(arguments);
  const SceneFrame scene =
      scene_frame(maps.front().cloud, maps.front().cameras, up_axis(arguments.up));
  const PointCloud first = cut_open(maps.front().cloud, scene);
  std::vector<CaptionedPicture> pictures;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const SurfaceMesh drawn = what_is_drawn(arguments, i, cut_open(maps[i].cloud, scene));
    for (const NamedSide& side : sides) {
      const View from = view_from(side.side, scene, first, {size.width_px, size.height_px});
      pictures.push_back(
          {render_smooth(drawn.vertices, from, drawn.triangles), caption(arguments, i, side.name)});
    }
  }
  const std::size_t columns = sides.size() > 1 ? sides.size() : pictures.size();
  write_file_atomically(arguments.out, encoded(tile_pictures(pictures, columns), arguments.out));
}

}  // namespace

void add_view_command(CLI::App& app, CommandResult&) {
  CLI::App* command = app.add_subcommand("view", "Draw pictures of maps, without a window");
  const auto arguments = std::make_shared<ViewArguments>();
  command
      ->add_option("MAP",
                   arguments->maps,
                   "PLY files of one room in one coordinate frame; trajectory.txt beside the first "
                   "determines the viewpoint")
      ->required();
  command->add_option("--out", arguments->out, "the picture, PNG, or JPEG as .jpg")->required();
  command->add_option("--from", arguments->from, "front, left, top or all")->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels of each view")
      ->capture_default_str();
  command
      ->add_option(
          "--up",
          arguments->up,
          "axis of the world frame that points up; by default found from floors and tables, "
          "starting from the cameras of the run, or from y down")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  CLI::Option* surface =
      command->add_flag("--surface",
                        arguments->surface,
                        "draw the surface as triangles, as `export --mesh` makes it");
  command
      ->add_option(
          "--mesh-cell", arguments->cell_m, "with --surface: edge of a cube of the mesh, metres")
      ->needs(surface)
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
  command->add_option("--name", arguments->names, "caption of a map; repeatable, in order")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option(
      "--groundtruth",
      arguments->groundtruth,
      "trajectory that aligns maps of several runs, and truth, in one coordinate frame");
  command->footer(
      "Examples:\n"
      "  stillmap view result/map.ply --out map.png\n"
      "  stillmap view result/map.ply --surface --from front --size 1280x960 --out room.png\n"
      "  stillmap view off/map.ply full/map.ply --from top --out both.png\n"
      "  stillmap view full/map.ply office/truth/static_map.ply --groundtruth "
      "office/groundtruth.txt --out truth.png");
  command->callback([arguments] { view(*arguments); });
}

}  // namespace stillmap
