// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/commands.hpp"
#include "apps/image_names.hpp"
#include "apps/option_value.hpp"
#include "apps/progress_bar.hpp"
#include "apps/sequence_option.hpp"
#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"
#include "stillmap/sensor/sequence_formats.hpp"
#include "tooling/pipeline/object_watch.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct SegmentArguments {
  SequenceArguments sequence;
  std::string out;
  std::string segmenter;
  std::size_t threads = 2;
};

// The detections of a frame, and the reason why its image could not be read, if it could not.
using Found = std::pair<FrameDetections, std::optional<std::string>>;

bool is_in(const fs::path& path, const fs::path& folder) {
  const auto [rest, unused] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return rest == folder.end();
}

// The canonical form of a path, whether it exists or not.
fs::path place_of(const fs::path& path) {
  std::error_code failure;
  fs::path place = fs::weakly_canonical(path, failure);
  if (failure) place = fs::absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

// Results have the same file names as masks and detections of the input may have.
void check_out(const SegmentArguments& arguments) {
  const fs::path out = place_of(arguments.out), sequence = place_of(arguments.sequence.path);
  bool overwrites = out == sequence;
  for (const char* folder : {"rgb", "color", "depth", "truth"}) {
    overwrites = overwrites || is_in(out, place_of(sequence / folder));
  }
  constexpr std::string_view kFolder = "detections:", kMasks = "masks:";
  if (arguments.segmenter.starts_with(kFolder)) {
    overwrites = overwrites || out == place_of(arguments.segmenter.substr(kFolder.size()));
  }
  if (arguments.segmenter.starts_with(kMasks)) {
    const fs::path masks = place_of(arguments.segmenter.substr(kMasks.size()));
    overwrites = overwrites || out == masks || out / "masks" == masks;
  }
  if (!overwrites) return;
  throw Error(
      "--out {}: this is the input, which would be overwritten; name another folder such as {}",
      arguments.out,
      (fs::path(arguments.sequence.path) / "detections").string());
}

// The size of the first image that can be read.
cv::Size image_size(const SequenceContent& content) {
  for (std::size_t i = 0; i < content.entries.size(); ++i) {
    try {
      return content.images->color(i).mat.size();
    } catch (const DamagedImage&) {
      if (i + 1 == content.entries.size()) throw;
    }
  }
  throw Error("a sequence without images");
}

Found segment_frame(const Segmenter& segmenter,
                    const SequenceContent& content,
                    std::size_t index,
                    cv::Size size) {
  const SequenceEntry& entry = content.entries[index];
  Found frame;
  try {
    const ColorImage color = content.images->color(index);
    if (color.mat.size() != size) {
      throw Error("{}: {}x{} pixels, expected {}x{} as the images before",
                  entry.color_file.string(),
                  color.mat.cols,
                  color.mat.rows,
                  size.width,
                  size.height);
    }
    frame.first = segmenter.segment(color, entry.stamp);
  } catch (const DamagedImage& damage) {
    frame.second = damage.what();
  }
  frame.first.stamp = entry.stamp;
  return frame;
}

void add_unknown_classes(const FrameDetections& frame, std::set<std::string>& unknown) {
  for (const DetectedObject& object : frame.objects) {
    if (!is_coco_class(object.class_name)) unknown.insert(object.class_name);
  }
}

void segment(const SegmentArguments& arguments) {
  check_out(arguments);
  const SequenceContent content = open_content(arguments.sequence);
  const std::vector<SequenceEntry>& entries = content.entries;
  const cv::Size size = image_size(content);
  // Frames are processed in parallel, each by one thread.
  const std::unique_ptr<Segmenter> segmenter =
      option_value("--segmenter", arguments.segmenter, [&](const std::string& text) {
        return make_segmenter(text, size, {.threads = 1, .image_names = image_names(entries)});
      });
  DetectionsWriter writer(arguments.out, size);

  std::size_t objects = 0;
  std::set<std::string> unknown;
  ProgressBar progress("frames");
  for (const std::string& warning : content.remarks.warnings) progress.warn(warning);
  const auto start = std::chrono::steady_clock::now();
  produce_in_parallel(
      entries.size(),
      arguments.threads,
      [&](std::size_t i) { return segment_frame(*segmenter, content, i, size); },
      [&](std::size_t i, const Found& frame) {
        if (frame.second) progress.warn(*frame.second + "; taken for a frame without objects");
        writer.add(frame.first);
        add_unknown_classes(frame.first, unknown);
        objects += frame.first.objects.size();
        progress.show(i + 1, entries.size());
      });
  writer.finish();
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
