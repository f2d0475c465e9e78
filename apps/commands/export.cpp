// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "apps/command_inputs.hpp"
#include "apps/commands.hpp"
#include "apps/commands/export_source.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/input_files.hpp"
#include "stillmap/io/ply.hpp"
#include "tooling/export/floor_plane.hpp"
#include "tooling/export/mesh_files.hpp"
#include "tooling/export/occupancy_grid.hpp"
#include "tooling/export/octree.hpp"
#include "tooling/export/pcd.hpp"
#include "tooling/export/surface_mesh.hpp"
#include "tooling/pipeline/run_folder.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::string source;
  std::string ply;
  std::string ply_ascii;
  std::string pcd;
  std::string pcd_ascii;
  std::string mesh;
  std::string octomap;
  std::string grid;
  bool upright = false;
  std::string camera;
  SpaceOptions space;
  HeightBand band;
  MeshOptions mesh_options;
};

struct FormatOption {
  const char* name;
  std::string ExportArguments::*file;
  std::vector<std::string> suffixes;
  const char* help;
};

const std::vector<FormatOption>& format_options() {
  static const std::vector<FormatOption> options = {
      {"--ply", &ExportArguments::ply, {".ply"}, "the map's points as binary PLY"},
      {"--ply-ascii", &ExportArguments::ply_ascii, {".ply"}, "the same as text"},
      {"--pcd", &ExportArguments::pcd, {".pcd"}, "the points as binary PCD, for PCL"},
      {"--pcd-ascii", &ExportArguments::pcd_ascii, {".pcd"}, "the same as text"},
      {"--mesh",
       &ExportArguments::mesh,
       {".ply", ".obj", ".glb"},
       "the surface as triangles with colours, normals and labels"},
      {"--octomap",
       &ExportArguments::octomap,
       {".bt", ".ot"},
       "occupied, free and unknown space; F.bt: OctoMap's binary tree, F.ot: with probabilities"},
      {"--grid",
       &ExportArguments::grid,
       {".yaml", ".yml"},
       "the navigation grid for map_server of ROS: F.yaml and F.pgm beside it"}};
  return options;
}

fs::path image_of_grid(const fs::path& grid) {
  return fs::path(grid).replace_extension(".pgm");
}

// The files of the run, whether they are read or not.
InputFiles input_files(const ExportArguments& arguments) {
  InputFiles inputs;
  std::error_code ignored;
  if (fs::is_directory(arguments.source, ignored)) {
    for (const std::string_view name : run_file_names()) {
      inputs.add(fs::path(arguments.source) / name);
    }
  } else {
    inputs.add(arguments.source);
  }
  add_camera(inputs, arguments.camera);
  return inputs;
}

// The checks that need no content of a file.
void check_arguments(const ExportArguments& arguments) {
  const InputFiles inputs = input_files(arguments);
  std::vector<fs::path> targets;
  for (const FormatOption& option : format_options()) {
    const fs::path file = arguments.*option.file;
    if (file.empty()) continue;
    if (std::ranges::find(option.suffixes, file.extension().string()) == option.suffixes.end()) {
      throw Error("{} {}: expected a name that ends in {}",
                  option.name,
                  file.string(),
                  joined(option.suffixes, " or "));
    }
    const fs::path target = fs::absolute(file).lexically_normal();
    if (std::ranges::find(targets, target) != targets.end()) {
      throw Error("{} {}: another option names the same file", option.name, file.string());
    }
    targets.push_back(target);
    inputs.check_output(option.name, file);
    if (option.file == &ExportArguments::grid) {
      inputs.check_output(option.name, image_of_grid(file));
    }
  }
  if (targets.empty()) {
    throw Error(
        "nothing to export: give one of --ply, --ply-ascii, --pcd, --pcd-ascii, --mesh, "
        "--octomap, --grid (see stillmap export --help)");
  }
  if (!(arguments.band.min_m < arguments.band.max_m)) {
    throw Error(
        "--min-height {} is not below --max-height {}", arguments.band.min_m, arguments.band.max_m);
  }
}

Eigen::Isometry3d find_floor_frame(const FinishedRun& run) {
  const std::optional<FloorPlane> floor = find_floor(run.map.positions, run.T_world_keyframe);
  if (floor) return floor_frame(*floor, run.T_world_keyframe.front());
  throw Error(
      "no floor found in the map, which --grid and --upright need: expected a plane of at least "
      "half "
      "a square metre below the cameras, held about upright, and nearly all of the map above it");
}

void transform(FinishedRun& run, const Eigen::Isometry3d& T) {
  run.map = moved(std::move(run.map), T);
  for (Eigen::Isometry3d& pose : run.T_world_keyframe) pose = T * pose;
}

void add_point_files(std::vector<FileContent>& files,
                     const ExportArguments& arguments,
                     const PointCloud& map) {
  if (!arguments.ply.empty()) files.push_back({arguments.ply, encode_ply(map)});
  if (!arguments.ply_ascii.empty()) {
    files.push_back({arguments.ply_ascii, encode_ply(map, PlyFormat::kAscii)});
  }
  if (!arguments.pcd.empty()) files.push_back({arguments.pcd, encode_pcd(map, PcdFormat::kBinary)});
  if (!arguments.pcd_ascii.empty()) {
    files.push_back({arguments.pcd_ascii, encode_pcd(map, PcdFormat::kAscii)});
  }
}

void add_mesh_file(std::vector<FileContent>& files,
                   const ExportArguments& arguments,
                   const PointCloud& map) {
  if (map.normals.empty()) {
    throw Error(
        "--mesh {}: the map has no normals, as maps of older versions and of modes other than "
        "full; run again, or with --set cloud.fusion=surface",
        arguments.mesh);
  }
  SurfaceMesh mesh;
  try {
    mesh = surface_mesh(map, arguments.mesh_options);
  } catch (const Error& error) {
    throw Error("--mesh-cell {}: {}", arguments.mesh_options.cell_m, error.what());
  }
  files.push_back({arguments.mesh, encode_mesh(mesh, arguments.mesh)});
}

void add_octree_file(std::vector<FileContent>& files,
                     const ExportArguments& arguments,
                     const FinishedRun& run) {
  const ObservedSpace space =
      observe_space(run.map.positions, run.T_world_keyframe, *run.camera, arguments.space);
  const OctreeFormat format =
      arguments.octomap.ends_with(".bt") ? OctreeFormat::kBinary : OctreeFormat::kFull;
  files.push_back({arguments.octomap, encode_octree(space, format)});
}

// `run` is in the coordinate frame of the grid.
void add_grid_files(std::vector<FileContent>& files,
                    const ExportArguments& arguments,
                    const FinishedRun& run,
                    const Eigen::Isometry3d& T_grid_map) {
  const OccupancyGrid grid = make_occupancy_grid(
      run.map.positions, run.T_world_keyframe, *run.camera, arguments.space, arguments.band);
  const fs::path image = image_of_grid(arguments.grid);
  files.push_back({image, encode_pgm(grid)});
  files.push_back({arguments.grid, format_grid_yaml(grid, image.filename().string(), T_grid_map)});
}

void add_space_files(std::vector<FileContent>& files,
                     const ExportArguments& arguments,
                     FinishedRun& run,
                     const Eigen::Isometry3d& T_grid_map) {
  try {
    if (!arguments.octomap.empty()) add_octree_file(files, arguments, run);
    if (arguments.grid.empty()) return;
    if (!arguments.upright) transform(run, T_grid_map);
    add_grid_files(files, arguments, run, T_grid_map);
  } catch (const ResolutionError& error) {
    throw Error("--resolution {}: {}", arguments.space.resolution_m, error.what());
  }
}

void run_export(const ExportArguments& arguments) {
  check_arguments(arguments);
  FinishedRun run = read_finished_run(
      arguments.source, arguments.camera, !arguments.octomap.empty() || !arguments.grid.empty());
  std::vector<FileContent> files;
  Eigen::Isometry3d T_grid_map = Eigen::Isometry3d::Identity();
  if (!arguments.grid.empty() || arguments.upright) T_grid_map = find_floor_frame(run);
  if (arguments.upright) transform(run, T_grid_map);
  add_point_files(files, arguments, run.map);
  if (!arguments.mesh.empty()) add_mesh_file(files, arguments, run.map);
  add_space_files(files, arguments, run, T_grid_map);
  write_files_atomically(files);
  for (const FileContent& file : files) {
    print_output(fmt::format("{:>11} bytes  {}\n", file.bytes.size(), file.path.string()));
  }
}

// CLI::Range accepts NaN.
CLI::Validator between(double low, double high) {
  return {[low, high](std::string& text) -> std::string {
            double value = 0;
            const bool fits =
                CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return fits ? "" : fmt::format("expected a number from {} to {}", low, high);
          },
          fmt::format("{} - {}", low, high)};
}

void add_settings(CLI::App& command, ExportArguments& arguments) {
  command
      .add_option("--resolution", arguments.space.resolution_m, "edge of a voxel or cell, metres")
      ->check(between(0.005, 1))
      ->capture_default_str();
  command
      .add_option(
          "--mesh-cell", arguments.mesh_options.cell_m, "edge of a cube of the mesh, metres")
      ->check(between(0.005, 1))
      ->capture_default_str();
  command
      .add_option("--max-range",
                  arguments.space.max_range_m,
                  "greatest distance from a camera at which space counts as free, metres")
      ->check(between(0.1, 100))
      ->capture_default_str();
  command
      .add_option("--min-height",
                  arguments.band.min_m,
                  "grid: least height above the floor of an obstacle, metres")
      ->check(between(0.01, 10))
      ->capture_default_str();
  command
      .add_option("--max-height",
                  arguments.band.max_m,
                  "grid: greatest height above the floor of an obstacle, metres")
      ->check(between(0.02, 20))
      ->capture_default_str();
  command.add_flag("--upright",
                   arguments.upright,
                   "clouds and octree in the floor's coordinate frame (z up, 0 on the floor)");
  command.add_option("--camera",
                     arguments.camera,
                     "tum_fr1, tum_fr2, tum_fr3, bonn or a camera.yaml; instead of the run's own");
}

}  // namespace

void add_export_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command = app.add_subcommand(
      "export", "Write the map of a finished run in the formats of other programs");
  const auto arguments = std::make_shared<ExportArguments>();
  command
      ->add_option("SOURCE",
                   arguments->source,
                   "the --out folder of `stillmap run`, or the map.stillmap in it")
      ->required();
  for (const FormatOption& option : format_options()) {
    command->add_option(option.name, (*arguments).*option.file, option.help)->type_name("F");
  }
  add_settings(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  stillmap export result --pcd map.pcd --ply-ascii map.ply\n"
      "  stillmap export result --mesh room.glb\n"
      "  stillmap export result --octomap map.bt --resolution 0.03 --upright\n"
      "  stillmap export result --grid room.yaml --min-height 0.05 --max-height 1.2\n"
      "  stillmap export result/map.stillmap --ply map.ply\n"
      "All files are written, or, when anything fails, none. docs/formats.md describes them.");
  command->callback([arguments] { run_export(*arguments); });
}

}  // namespace stillmap
