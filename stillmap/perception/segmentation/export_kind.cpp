// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/export_kind.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/segmentation/export_readings.hpp"

namespace stillmap {
namespace {

constexpr std::array<std::string_view, 20> kVoc = {
    "aeroplane", "bicycle",     "bird",  "boat",        "bottle", "bus",      "car",
    "cat",       "chair",       "cow",   "diningtable", "dog",    "horse",    "motorbike",
    "person",    "pottedplant", "sheep", "sofa",        "train",  "tvmonitor"};

// The names of `classes` classes: those in the network's metadata, else those of COCO or VOC.
// Nothing if none has this number. Names in the metadata decide an open number.
std::optional<std::vector<std::string>> names_of(const std::vector<std::string>& given,
                                                 const ExportReading& reading) {
  const std::size_t background = reading.with_background ? 1 : 0;
  const bool is_map = reading.network.kind == ExportKind::kClassMap;
  const std::size_t usual = is_map ? kVoc.size() : coco_class_names().size();
  if (!reading.classes && !given.empty()) return given;
  const auto count =
      reading.classes ? static_cast<std::size_t>(*reading.classes) : usual + background;
  if (!given.empty() && given.size() == count) return given;
  std::vector<std::string> names(background, "background");
  if (!given.empty()) {
    names.insert(names.end(), given.begin(), given.end());
  } else if (count == coco_class_names().size() + background) {
    names.insert(names.end(), coco_class_names().begin(), coco_class_names().end());
  } else if (count == kVoc.size() + background) {
    names.insert(names.end(), kVoc.begin(), kVoc.end());
  }
  if (names.size() != count) return std::nullopt;
  return names;
}

// Tasks of Ultralytics' exports whose outputs could be taken for others.
void check_task(const std::string& task) {
  for (const std::string_view other : {"classify", "pose", "obb"}) {
    if (task != other) continue;
    throw Error("a network for the task '{}': expected one that detects or segments objects", task);
  }
}

bool is_vector(const TensorShape& shape) {
  return without_batch(shape, 0).size() <= 1 ||
         std::ranges::count_if(shape, [](std::int64_t size) { return size != 1; }) <= 1;
}

[[noreturn]] void refuse_unknown(const std::vector<Tensor>& outputs) {
  std::vector<std::string> texts;
  for (const Tensor& output : outputs) texts.push_back(shape_text(output.shape));
  if (outputs.size() == 1 && is_vector(outputs[0].shape)) {
    throw Error(
        "a network with the output {}, as image classifiers have: expected one that says where "
        "in the image objects are, by boxes or masks",
        texts[0]);
  }
  throw Error(
      "a network with the outputs {}: expected a class map, YOLO, RT-DETR, BlitzNet, NanoDet or "
      "CenterNet (docs/segmentation.md has their shapes)",
      joined(texts, ", "));
}

[[noreturn]] void refuse_names(const std::vector<std::string>& given,
                               const ExportReading& reading) {
  if (!given.empty()) {
    throw Error("a network of {} classes with {} names in its metadata entry 'names': expected {}",
                *reading.classes,
                given.size(),
                *reading.classes);
  }
  throw Error(
      "a network of {} classes without their names: expected those of COCO or VOC, or as many "
      "names in its metadata entry 'names'",
      *reading.classes);
}

}  // namespace

TensorShape image_input_shape(const NetworkSignature& signature, cv::Size image) {
  constexpr std::int64_t kMostBatch = 64;
  const TensorShape shape =
      signature.inputs.size() == 1 ? signature.inputs[0].shape : TensorShape();
  const bool first = shape.size() == 4 && shape[1] == 3;
  const bool last = shape.size() == 4 && !first && shape[3] == 3;
  if ((!first && !last) || shape[0] > kMostBatch) {
    std::vector<std::string> texts;
    for (const NamedShape& input : signature.inputs) texts.push_back(shape_text(input.shape));
    throw Error(
        "a network with the inputs {}: expected one image, 1x3xHxW or 1xHxWx3, or at most {} in "
        "one "
        "batch",
        texts.empty() ? "none" : joined(texts, ", "),
        kMostBatch);
  }
  constexpr std::int64_t kStep = 32, kMostSide = 8192;
  const auto size_or = [&](std::int64_t size, int image_size) {
    return size > 0 ? size : (image_size + kStep - 1) / kStep * kStep;
  };
  const std::int64_t batch = std::max<std::int64_t>(shape[0], 1);
  const std::int64_t height = size_or(shape[first ? 2 : 1], image.height);
  const std::int64_t width = size_or(shape[first ? 3 : 2], image.width);
  TensorShape input =
      first ? TensorShape{batch, 3, height, width} : TensorShape{batch, height, width, 3};
  if (height > kMostSide || width > kMostSide || element_count(input) < 0) {
    throw Error("a network for {} images of {}x{} pixels, expected at most {} a side",
                batch,
                width,
                height,
                kMostSide);
  }
  return input;
}

NetworkExport identify_export(const NetworkSignature& signature,
                              const std::vector<Tensor>& outputs,
                              cv::Size input) {
  check_task(signature.task);
  const std::vector<ExportReading> readings = readings_of(outputs, input);
  if (readings.empty()) refuse_unknown(outputs);
  const std::vector<std::string> given = quoted_words(signature.class_names);
  std::string objection;
  for (const ExportReading& reading : readings) {
    std::optional<std::vector<std::string>> names = names_of(given, reading);
    if (!names) continue;
    NetworkExport network = reading.network;
    network.names = *std::move(names);
    const std::string problem = contradiction(network, outputs);
    if (problem.empty()) return network;
    if (objection.empty()) objection = problem;
  }
  if (objection.empty()) refuse_names(given, readings.front());
  throw Error("the network's output for an empty image: {}", objection);
}

std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char quote = text[i];
    if (quote != '\'' && quote != '"') continue;
    const std::size_t end = text.find(quote, i + 1);
    if (end == std::string_view::npos) break;
    words.push_back(usable_class_name(text.substr(i + 1, end - i - 1)));
    i = end;
  }
  return words;
}

}  // namespace stillmap
