// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/commands.hpp"
#include "apps/picture_size.hpp"
#include "apps/progress_bar.hpp"
#include "simulation/synth/scene_names.hpp"
#include "simulation/synth/sequence_writer.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

struct SynthArguments {
  std::string out;
  std::string scene;
  std::size_t frames = 0;  // 0: all frames of the scene
  std::uint32_t seed = 0;
  std::string size = "640x480";
  bool clean = false;
  std::vector<std::string> without;
  std::string detections = "none";
  std::string assets = "auto";
  double stereo_baseline_m = 0;
  ImageDelays delays;
  bool hide_depth_delay = false;
  std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
};

// What --without leaves out, by name.
struct Effect {
  std::string_view name;
  void (*remove)(SyntheticOptions&);
};
constexpr std::array<Effect, 8> kEffects{{
    {"people", [](SyntheticOptions& o) { o.activity = Activity::kNone; }},
    {"shadows", [](SyntheticOptions& o) { o.render.light.shadows = false; }},
    {"antialiasing", [](SyntheticOptions& o) { o.render.antialiasing = false; }},
    {"motion-blur", [](SyntheticOptions& o) { o.sensor.exposure_s = 0; }},
    {"exposure-drift", [](SyntheticOptions& o) { o.sensor.exposure_drift = false; }},
    {"color-noise", [](SyntheticOptions& o) { o.sensor.color_noise = false; }},
    {"depth-noise", [](SyntheticOptions& o) { o.sensor.depth_noise = false; }},
    {"depth-holes", [](SyntheticOptions& o) { o.sensor.depth_holes = false; }},
}};

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const Effect& effect : kEffects) names.emplace_back(effect.name);
  return names;
}

void remove_effect(SyntheticOptions& options, const std::string& name) {
  for (const Effect& effect : kEffects) {
    if (effect.name == name) return effect.remove(options);
  }
  throw Error("--without {}: {}", name, name_hint(name, effect_names()));
}

DetectionKind detection_kind(const std::string& name) {
  if (name == "none") return DetectionKind::kNone;
  if (name == "perfect") return DetectionKind::kPerfect;
  if (name == "imperfect") return DetectionKind::kImperfect;
  const std::vector<std::string> known = {"none", "perfect", "imperfect"};
  throw Error("--detections {}: {}", name, name_hint(name, known));
}

// Null: no assets.
std::shared_ptr<const Assets> chosen_assets(const std::string& name) {
  const std::vector<std::string> known = {"auto", "none"};
  if (name == "none") return nullptr;
  if (name != "auto") throw Error("--assets {}: {}", name, name_hint(name, known));
  try {
    std::optional<Assets> assets = installed_assets();
    if (!assets) return nullptr;
    return std::make_shared<const Assets>(std::move(*assets));
  } catch (const Error& error) {
    throw Error("{}; or leave it out with --assets none", error.what());
  }
}

std::string assets_line(const SyntheticOptions& options) {
  if (!options.assets) return "assets      none; people and furniture are made in code\n";
  return fmt::format(
      "assets      {} people and {} chairs of sweethome3d-furniture, see assets.txt\n",
      options.assets->people.size(),
      options.assets->chairs.size());
}

CameraModel camera_of_size(const std::string& text) {
  const PictureSize size = parse_picture_size(text);
  return synthetic_camera(size.width_px, size.height_px);
}

void render(const SynthArguments& arguments) {
  const NamedScene scene = named_scene(arguments.scene);
  SyntheticOptions options;
  options.path = scene.path;
  options.activity = scene.activity;
  options.frames = arguments.frames > 0 ? arguments.frames : scene.frames;
  options.camera = camera_of_size(arguments.size);
  options.seed = arguments.seed;
  if (arguments.clean) options.sensor = SensorOptions::clean();
  for (const std::string& name : arguments.without) remove_effect(options, name);
  options.delays = arguments.delays;
  options.delays.depth_stamps_tell = !arguments.hide_depth_delay;
  const DetectionKind detections = detection_kind(arguments.detections);
  options.assets = chosen_assets(arguments.assets);

  ProgressBar progress("frames");
  write_sequence(SyntheticSequence(options),
                 arguments.out,
                 {.threads = arguments.threads,
                  .detections = detections,
                  .stereo_baseline_m = arguments.stereo_baseline_m},
                 [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  progress.finish();
  print_output(fmt::format(
      "sequence    {} frames of {} in {}\n", options.frames, arguments.size, arguments.out));
  print_output(assets_line(options));
}

// When the rows of the images are taken.
void add_time_options(CLI::App& command, const std::shared_ptr<SynthArguments>& arguments) {
  command
      .add_option("--readout",
                  arguments->delays.readout_s,
                  "a rolling shutter: seconds from the first row of a colour image to the last")
      ->check(CLI::Range(0.0, 0.1));
  command
      .add_option("--depth-readout",
                  arguments->delays.depth_readout_s,
                  "the same of a depth image, seconds")
      ->check(CLI::Range(0.0, 0.1));
  CLI::Option* delay =
      command
          .add_option("--depth-delay",
                      arguments->delays.depth_delay_s,
                      "how much later than the colour image each depth image is taken, seconds")
          ->check(CLI::Range(-0.1, 0.1));
  command
      .add_flag("--hide-depth-delay",
                arguments->hide_depth_delay,
                "depth images get the stamps of the colour images, as if taken with them")
      ->needs(delay);
}

}  // namespace

void add_synth_command(CLI::App& app, CommandResult&) {
  CLI::App* command = app.add_subcommand("synth", "Render a sequence with exact truth");
  const auto arguments = std::make_shared<SynthArguments>();
  command->add_option("OUT", arguments->out, "new or empty folder for the sequence")->required();
  command
      ->add_option(
          "--scene", arguments->scene, fmt::format("one of: {}", joined(scene_names(), ", ")))
      ->required();
  command->add_option("--frames", arguments->frames, "number of frames, at 30 a second")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100000}));
  command
      ->add_option("--seed", arguments->seed, "varies pictures, clothes and noise, not the layout")
      ->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command->add_flag(
      "--clean", arguments->clean, "a perfect sensor: no noise, blur, drift or missing depth");
  command->add_option("--without",
                      arguments->without,
                      fmt::format("leaves one thing or effect out, repeatable; one of: {}",
                                  joined(effect_names(), ", ")));
  command
      ->add_option("--detections",
                   arguments->detections,
                   "also write detections/ from the truth: none, perfect, or imperfect, which "
                   "has the faults of a network")
      ->capture_default_str();
  command
      ->add_option("--stereo",
                   arguments->stereo_baseline_m,
                   "also write mav0/, stereo pairs in the layout of EuRoC: a second camera, this "
                   "many metres to the right")
      ->check(CLI::Range(0.001, 10.0));
  add_time_options(*command, arguments);
  command
      ->add_option("--assets",
                   arguments->assets,
                   "people and chairs of the Debian package sweethome3d-furniture: auto (if it "
                   "is installed) or none")
      ->capture_default_str();
  command
      ->add_option(
          "--threads", arguments->threads, "number of rendering threads; the result is the same")
      ->check(CLI::Range(std::size_t{1}, std::size_t{256}))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  stillmap synth office --scene walking_xyz --detections imperfect\n"
      "  stillmap synth round --scene loop --size 320x240 --seed 7 --clean");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace stillmap
