// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/commands/evaluate.hpp"
#include "tooling/eval/map_files.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/metrics_json.hpp"

namespace stillmap {
namespace {

struct MapArguments {
  std::string map;
  std::string static_truth;
  std::string dynamic_truth;
  std::string resting_truth;
  std::string groundtruth;
  std::string trajectory;
  bool json = false;
};

// The map in the coordinate frame of the truth.
PointCloud aligned(const PointCloud& map, const MapArguments& arguments) {
  if (arguments.groundtruth.empty()) return map;
  PointCloud result = moved(map,
                            required_alignment(read_trajectory_file(arguments.groundtruth),
                                               read_trajectory_file(arguments.trajectory)));
  check_extent(result, arguments.map + ", moved to the ground truth");
  return result;
}

std::string row(const char* name, const std::optional<double>& value, const char* unit = "") {
  return value ? fmt::format("{:<22} {:>9.4f} {}\n", name, *value, unit)
               : fmt::format("{:<22} {:>9}\n", name, "-");
}

std::string percent_row(const char* name, const std::optional<double>& ratio) {
  return row(name, ratio ? std::optional(100 * *ratio) : std::nullopt, "%");
}

std::string as_table(const MapQuality& quality, std::size_t points) {
  std::string text = fmt::format("map of {} points, {} of 2 cm\n", points, quality.voxels);
  text += row("static accuracy sa", quality.sa);
  text += row("dynamic accuracy da", quality.da);
  text += row("geometric mean aa", quality.aa);
  text += row("harmonic mean ha", quality.ha);
  text += row("accuracy", quality.accuracy_m, "m");
  text += row("completeness", quality.completeness_m, "m");
  if (quality.ghosts) {
    text += percent_row("ghosts", quality.ghosts->ratio);
    text += row("ghost volume", quality.ghosts->volume_l, "l");
    text += fmt::format("{:<22} {:>9}\n", "ghost clusters", quality.ghosts->clusters);
  }
  text += percent_row("over 5 cm off", quality.off_ratio_5cm);
  text += percent_row("over 10 cm off", quality.off_ratio_10cm);
  return text;
}

std::optional<std::filesystem::path> if_given(const std::string& file) {
  return file.empty() ? std::nullopt : std::optional<std::filesystem::path>(file);
}

void evaluate_map(const MapArguments& arguments) {
  const MapTruth truth = read_map_truth(
      arguments.static_truth, if_given(arguments.dynamic_truth), if_given(arguments.resting_truth));
  const PointCloud map = read_map(arguments.map);
  const MapQuality quality = map_quality(aligned(map, arguments), truth);
  nlohmann::ordered_json json = {{"map", {{"points", map.size()}}}};
  json["map"].update(map_quality_json(quality));
  print_output(arguments.json ? json.dump(2) + "\n" : as_table(quality, map.size()));
}

}  // namespace

void add_evaluate_map(CLI::App& evaluate) {
  const std::shared_ptr<MapArguments> arguments = std::make_shared<MapArguments>();
  CLI::App& command = *evaluate.add_subcommand(
      "map", "A map against true surfaces: completeness, ghosts, accuracy");
  command.add_option("MAP", arguments->map, "the map, PLY")->required();
  command.add_option("--static", arguments->static_truth, "true static surface, PLY")->required();
  command.add_option("--dynamic", arguments->dynamic_truth, "surface swept by moving objects, PLY");
  command.add_option("--resting",
                     arguments->resting_truth,
                     "moved things where they were last seen to stand, PLY: they count on neither "
                     "side");
  CLI::Option* groundtruth = command.add_option("--groundtruth",
                                                arguments->groundtruth,
                                                "true trajectory; with --trajectory it aligns the "
                                                "map, else map and truth share a coordinate frame");
  CLI::Option* trajectory =
      command.add_option("--trajectory", arguments->trajectory, "the trajectory of the map's run");
  groundtruth->needs(trajectory);
  trajectory->needs(groundtruth);
  command.add_flag("--json", arguments->json, "print JSON and nothing else");
  command.callback([arguments] { evaluate_map(*arguments); });
}

}  // namespace stillmap
