// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/command_inputs.hpp"
#include "apps/commands.hpp"
#include "apps/image_names.hpp"
#include "apps/option_value.hpp"
#include "apps/progress_bar.hpp"
#include "apps/sensor_camera.hpp"
#include "apps/sequence_option.hpp"
#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"
#include "stillmap/sensor/image_warnings.hpp"
#include "stillmap/sensor/sequence_formats.hpp"
#include "tooling/pipeline/object_watch.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct SegmentArguments {
  SequenceArguments sequence;
  std::string out;
  std::string segmenter;
  std::optional<double> depth_factor;
  std::size_t threads = 2;
};

struct Found {
  FrameDetections detections;
  DepthImage depth;     // empty where it is not used, or damaged
  std::string damage;   // why the image could not be read; empty if it could
  std::string warning;  // what is wrong with its file beside the pixels
};

void check_out(const SegmentArguments& arguments, const std::vector<SequenceEntry>& entries) {
  InputFiles inputs;
  add_sequence(inputs, arguments.sequence.path, entries);
  add_segmenter(inputs, arguments.segmenter);
  inputs.check_output("--out", fs::path(arguments.out) / "detections.jsonl");
  inputs.check_output("--out", fs::path(arguments.out) / "masks");
}

// The size of the first image that can be read.
cv::Size image_size(const SequenceContent& content) {
  for (std::size_t i = 0; i < content.entries.size(); ++i) {
    try {
      return content.images->color(i).color.mat.size();
    } catch (const DamagedImage&) {
      if (i + 1 == content.entries.size()) throw;
    }
  }
  throw Error("a sequence without images");
}

// The sequence with a camera that tells metres; nothing, and why not, where none is known.
std::optional<Sequence> open_with_depth(const SegmentArguments& arguments, std::string& why_not) {
  try {
    Sequence sequence = open_sequence(arguments.sequence);
    sequence.use_camera(sensor_camera(sequence, {}, arguments.depth_factor).camera);
    return sequence;
  } catch (const UnknownCamera& unknown) {
    why_not = unknown.what();
  } catch (const UnknownDepthUnit& unknown) {
    why_not = unknown.what();
  }
  return std::nullopt;
}

struct Images {
  ColorFile color;
  DepthImage depth;  // empty where it is not used, or damaged
};

// The images of an entry, each decoded once.
Images read_images(const SequenceContent& content,
                   const std::optional<Sequence>& with_depth,
                   std::size_t index) {
  if (with_depth) {
    try {
      const FrameReading reading =
          with_depth->read_with_warning(FrameId(static_cast<std::uint32_t>(index)));
      return {{reading.frame->color, reading.warning}, reading.frame->depth};
    } catch (const DamagedImage&) {
      // A run leaves this frame out. Its colour image may be whole.
    }
  }
  return {content.images->color(index), {}};
}

// Gives the objects of one frame after another the masks that a run gives them.
class DepthMasks {
 public:
  FrameDetections complete(FrameDetections detections, const DepthImage& depth) {
    if (depth.mat.empty()) return detections;
    const FrameObjects objects =
        tracker_.push({FrameId(frames_++), std::move(detections), depth}).value();
    FrameDetections result{objects.stamp, {}, objects.mask};
    for (const TrackedObject& object : objects.objects) {
      if (!object.filled) result.objects.push_back(object.detection);
    }
    const auto detected = static_cast<double>(result.objects.size());
    if (result.mask.mat.empty() || result.objects.size() == objects.objects.size()) return result;
    result.mask.mat.setTo(0, result.mask.mat > detected);  // filled objects come last
    return result;
  }

 private:
  ObjectTracker tracker_{{}, FillRule::kCausal};
  std::uint32_t frames_ = 0;
};

Found segment_frame(const Segmenter& segmenter,
                    const SequenceContent& content,
                    const std::optional<Sequence>& with_depth,
                    std::size_t index,
                    cv::Size size) {
  const SequenceEntry& entry = content.entries[index];
  Found frame;
  try {
    const auto [file, depth] = read_images(content, with_depth, index);
    const ColorImage& color = file.color;
    if (color.mat.size() != size) {
      throw Error("{}: {}x{} pixels, expected {}x{} as the images before",
                  entry.color_file.string(),
                  color.mat.cols,
                  color.mat.rows,
                  size.width,
                  size.height);
    }
    frame.detections = segmenter.segment(color, entry.stamp);
    frame.warning = file.warning;
    frame.depth = depth;
  } catch (const DamagedImage& damage) {
    frame.damage = damage.what();
  }
  frame.detections.stamp = entry.stamp;
  return frame;
}

void add_unknown_classes(const FrameDetections& frame, std::set<std::string>& unknown) {
  for (const DetectedObject& object : frame.objects) {
    if (!is_coco_class(object.class_name)) unknown.insert(object.class_name);
  }
}

void segment(const SegmentArguments& arguments) {
  const SequenceContent content = open_content(arguments.sequence);
  const std::vector<SequenceEntry>& entries = content.entries;
  check_out(arguments, entries);
  const cv::Size size = image_size(content);
  // Frames are processed in parallel, each by one thread.
  const std::unique_ptr<Segmenter> segmenter =
      option_value("--segmenter", arguments.segmenter, [&](const std::string& text) {
        return make_segmenter(text, size, {.threads = 1, .image_names = image_names(entries)});
      });
  DetectionsWriter writer(arguments.out, size);

  std::string no_depth;
  const std::optional<Sequence> with_depth = open_with_depth(arguments, no_depth);
  DepthMasks masks;
  std::size_t objects = 0;
  std::set<std::string> unknown;
  ImageWarnings warnings;
  ProgressBar progress("frames");
  for (const std::string& warning : content.remarks.warnings) progress.warn(warning);
  if (!no_depth.empty()) progress.warn(no_depth + "; masks by depth are left to `stillmap run`");
  const auto start = std::chrono::steady_clock::now();
  produce_in_parallel(
      entries.size(),
      arguments.threads,
      [&](std::size_t i) { return segment_frame(*segmenter, content, with_depth, i, size); },
      [&](std::size_t i, const Found& frame) {
        if (!frame.damage.empty()) {
          progress.warn(frame.damage + "; taken for a frame without objects");
        }
        warnings.add(frame.warning);
        writer.add(masks.complete(frame.detections, frame.depth));
        add_unknown_classes(frame.detections, unknown);
        objects += frame.detections.objects.size();
        progress.show(i + 1, entries.size());
      });
  writer.finish();
  for (const std::string& line : warnings.lines()) progress.warn(line);
  if (!unknown.empty()) progress.warn(unknown_classes_warning(unknown));
  progress.finish();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  print_output(fmt::format(
      "detections  {} objects in {} frames, in {}\ntime        {:.1f} s, {:.1f} frames a second\n",
      objects,
      entries.size(),
      arguments.out,
      took.count(),
      static_cast<double>(entries.size()) / took.count()));
}

}  // namespace

void add_segment_command(CLI::App& app, CommandResult&) {
  CLI::App* command =
      app.add_subcommand("segment", "Find people and things in every image of a sequence");
  const auto arguments = std::make_shared<SegmentArguments>();
  add_sequence_options(*command, arguments->sequence);
  command
      ->add_option("--out",
                   arguments->out,
                   "folder for detections.jsonl and masks/; for `run` "
                   "--segmenter detections:FOLDER")
      ->required();
  command
      ->add_option("--segmenter",
                   arguments->segmenter,
                   "auto (the networks that tools/fetch_models gets), onnx:MODEL.onnx, "
                   "detections:DIR or masks:DIR (plain masks of people)")
      ->required();
  command->add_option(
      "--camera", arguments->sequence.camera, "its name or file, as for `run`; for masks by depth");
  command
      ->add_option("--depth-factor",
                   arguments->depth_factor,
                   "units of a depth image per metre, such as 1000; instead of the camera's")
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--threads", arguments->threads, "number of frames that are processed in parallel")
      ->check(CLI::Range(std::size_t{1}, std::size_t{64}))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  stillmap segment office --out office/detections --segmenter auto\n"
      "  stillmap segment office --out found --segmenter onnx:yolov8n-seg.onnx --threads 4");
  command->callback([arguments] { segment(*arguments); });
}

}  // namespace stillmap
