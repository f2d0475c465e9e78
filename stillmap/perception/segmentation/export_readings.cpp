// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/export_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/segmentation/detr.hpp"
#include "stillmap/perception/segmentation/yolo.hpp"

namespace stillmap {
namespace {

using Readings = std::vector<ExportReading>;

std::vector<std::size_t> outputs_of_rank(const std::vector<Tensor>& outputs, std::size_t rank) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].shape.size() == rank) found.push_back(i);
  }
  return found;
}

// Whether a plane is as large as a map of the input: of its aspect ratio, and between a
// thirty-second and four times its size, give or take the rounding of strides.
bool is_map_size(std::int64_t height, std::int64_t width, cv::Size input) {
  constexpr std::int64_t kLeastSide = 4;
  constexpr double kLeastScale = 1.0 / 33, kMostScale = 4.1, kRounding = 2, kTolerance = 0.05;
  if (height < kLeastSide || width < kLeastSide) return false;
  const double scale = static_cast<double>(width) / input.width;
  const double expected = scale * input.height;
  return scale >= kLeastScale && scale <= kMostScale &&
         std::abs(expected - static_cast<double>(height)) <=
             std::max(kRounding, kTolerance * expected);
}

void add_class_maps(const std::vector<Tensor>& outputs, cv::Size input, Readings& readings) {
  if (outputs.size() != 1) return;
  const TensorShape shape = without_batch(outputs[0].shape, 2);
  const NetworkExport map{ExportKind::kClassMap, {0}, {}, false};
  if (shape.size() == 2 && is_map_size(shape[0], shape[1], input)) {
    readings.push_back({map, std::nullopt, true});
  }
  if (shape.size() != 3) return;
  if (is_map_size(shape[1], shape[2], input)) readings.push_back({map, shape[0], true});
  if (is_map_size(shape[0], shape[1], input)) {
    readings.push_back({map, shape[2], true});
    readings.back().network.channels_last = true;
  }
}

// The kinds of YOLO, with prototypes of masks or without.
void add_yolo(const std::vector<Tensor>& outputs, cv::Size input, Readings& readings) {
  // Networks that suppress overlaps themselves give some hundred boxes at most.
  constexpr std::int64_t kMostFinal = 3000;
  const std::vector<std::size_t> boxes = outputs_of_rank(outputs, 3);
  const std::vector<std::size_t> planes = outputs_of_rank(outputs, 4);
  if (boxes.size() != 1 || planes.size() > 1 || outputs.size() != 1 + planes.size()) return;
  const TensorShape& shape = outputs[boxes[0]].shape;
  std::int64_t prototypes = 0;
  if (!planes.empty()) {
    const TensorShape& plane = outputs[planes[0]].shape;
    if (!is_map_size(plane[2], plane[3], input)) return;
    prototypes = plane[1];
  }
  std::vector<std::size_t> used = {boxes[0]};
  used.insert(used.end(), planes.begin(), planes.end());
  if (shape[2] == 6 + prototypes && shape[1] <= kMostFinal) {
    readings.push_back({{ExportKind::kYoloFinal, used, {}, false}, std::nullopt, false});
  }
  if (shape[2] >= shape[1] && shape[1] > 4 + prototypes) {
    readings.push_back(
        {{ExportKind::kYoloColumns, used, {}, false}, shape[1] - 4 - prototypes, false});
  }
  if (shape[1] > shape[2] && shape[2] > 5 + prototypes) {
    readings.push_back(
        {{ExportKind::kYoloRows, used, {}, false}, shape[2] - 5 - prototypes, false});
  }
}

void add_detr(const std::vector<Tensor>& outputs, Readings& readings) {
  // More rows are the cells of a grid.
  constexpr std::int64_t kMostQueries = 2000;
  const std::vector<std::size_t> rows = outputs_of_rank(outputs, 3);
  if (rows.size() != outputs.size() || rows.empty() || rows.size() > 2) return;
  if (outputs[0].shape[1] > kMostQueries) return;
  if (rows.size() == 1) {
    const std::int64_t classes = outputs[0].shape[2] - 4;
    if (classes > 0) readings.push_back({{ExportKind::kDetr, {0}, {}, false}, classes, false});
    return;
  }
  const std::size_t boxes = outputs[0].shape[2] == 4 ? 0 : 1, scores = 1 - boxes;
  if (outputs[boxes].shape[2] != 4 || outputs[0].shape[1] != outputs[1].shape[1]) return;
  readings.push_back(
      {{ExportKind::kDetr, {boxes, scores}, {}, false}, outputs[scores].shape[2], false});
}

void add_ssd(const std::vector<Tensor>& outputs, cv::Size input, Readings& readings) {
  const std::vector<std::size_t> maps = outputs_of_rank(outputs, 4);
  const std::vector<std::size_t> anchors = outputs_of_rank(outputs, 2);
  const std::vector<std::size_t> rows = outputs_of_rank(outputs, 3);
  if (maps.size() != 1 || anchors.size() != 1 || rows.size() != 2) return;
  const bool offsets_first = outputs[rows[0]].shape[2] == 4;
  const std::size_t offsets = rows[offsets_first ? 0 : 1], classes = rows[offsets_first ? 1 : 0];
  if (outputs[offsets].shape[2] != 4) return;
  const TensorShape& map = outputs[maps[0]].shape;
  const std::int64_t count = outputs[classes].shape[2];
  const bool first = map[1] == count && is_map_size(map[2], map[3], input);
  const bool last = map[3] == count && is_map_size(map[1], map[2], input);
  if (!first && !last) return;
  readings.push_back(
      {{ExportKind::kSsd, {anchors[0], offsets, classes, maps[0]}, {}, !first}, count, true});
}

// Pairs of outputs with equal numbers of rows. All boxes have the same number of columns, a
// multiple of 4, and all classes have the same number of columns, too.
void add_nanodet(const std::vector<Tensor>& outputs, Readings& readings) {
  std::vector<std::size_t> order = outputs_of_rank(outputs, 3);
  if (outputs.size() < 4 || outputs.size() % 2 != 0 || order.size() != outputs.size()) return;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(outputs[a].shape[1], outputs[a].shape[2]) >
           std::pair(outputs[b].shape[1], outputs[b].shape[2]);
  });
  const auto columns = [&](std::size_t place) { return outputs[order[place]].shape[2]; };
  for (std::size_t i = 0; i < order.size(); i += 2) {
    const bool same_rows = outputs[order[i]].shape[1] == outputs[order[i + 1]].shape[1];
    const bool fit = same_rows && columns(i + 1) % 4 == 0 && columns(i) == columns(0) &&
                     columns(i + 1) == columns(1);
    if (!fit) return;
  }
  readings.push_back({{ExportKind::kNanoDet, order, {}, false}, columns(0), false});
}

void add_centernet(const std::vector<Tensor>& outputs, cv::Size input, Readings& readings) {
  if (outputs.size() != 2 || outputs_of_rank(outputs, 4).size() != 2) return;
  const std::size_t sizes = outputs[0].shape[3] == 4 ? 0 : 1;
  const TensorShape& heat = outputs[1 - sizes].shape;
  if (outputs[sizes].shape[3] != 4 || !is_map_size(heat[1], heat[2], input)) return;
  readings.push_back({{ExportKind::kCenterNet, {1 - sizes, sizes}, {}, false}, heat[3], false});
}

// The message of the Error that a decoder throws; empty if it throws none.
template <class Decode>
std::string refusal_of(const Decode& decode) {
  try {
    decode();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

// Among the boxes of an empty image, most of which hold no object, some are large.
std::string yolo_problem(const NetworkExport& network, const std::vector<Tensor>& outputs) {
  constexpr float kLeastScore = 1e-6F;  // rows without an object may have no class
  constexpr double kLargestShare = 2;
  std::vector<Candidate> boxes;
  std::string refusal = refusal_of([&] {
    boxes = decode_yolo_boxes(yolo_outputs(network, outputs), network.names.size(), kLeastScore);
  });
  const auto is_share = [](const Candidate& candidate) {
    return candidate.box.x1 < kLargestShare && candidate.box.y1 < kLargestShare;
  };
  if (!refusal.empty() || boxes.empty() || !std::ranges::all_of(boxes, is_share)) return refusal;
  return "all boxes lie in 0 to 1, expected pixels of the network's input";
}

std::string not_probabilities(const Tensor& scores) {
  const auto odd =
      std::ranges::find_if(scores.values, [](float score) { return is_no_probability(score); });
  return odd == scores.values.end() ? "" : no_probability_text(*odd);
}

std::string not_class_numbers(const Tensor& map, std::size_t classes) {
  for (const float value : map.values) {
    if (value >= 0 && value == std::floor(value) && value < static_cast<float>(classes)) continue;
    return fmt::format(
        "a map of class numbers holds {}, expected whole numbers from 0 to {}", value, classes - 1);
  }
  return "";
}

}  // namespace

Readings readings_of(const std::vector<Tensor>& outputs, cv::Size input) {
  Readings readings;
  add_yolo(outputs, input, readings);
  add_detr(outputs, readings);
  add_class_maps(outputs, input, readings);
  add_ssd(outputs, input, readings);
  add_nanodet(outputs, readings);
  add_centernet(outputs, input, readings);
  return readings;
}

std::string contradiction(const NetworkExport& network, const std::vector<Tensor>& outputs) {
  const auto output = [&](std::size_t i) { return outputs.at(network.outputs[i]).view(); };
  switch (network.kind) {
    case ExportKind::kYoloRows:
    case ExportKind::kYoloColumns:
    case ExportKind::kYoloFinal:
      return yolo_problem(network, outputs);
    case ExportKind::kDetr:
      return refusal_of([&] { (void)decode_detr(detr_outputs(network, outputs), {1, 1}, 0); });
    case ExportKind::kClassMap:
      return without_batch(output(0).shape, 2).size() == 2
                 ? not_class_numbers(outputs[network.outputs[0]], network.names.size())
                 : "";
    case ExportKind::kNanoDet:
    case ExportKind::kCenterNet:
      return not_probabilities(outputs[network.outputs[0]]);
    case ExportKind::kSsd:
      return "";
  }
  return "";
}

}  // namespace stillmap
