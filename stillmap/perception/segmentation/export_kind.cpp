// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/export_kind.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

constexpr std::array<std::string_view, 20> kVoc = {
    "aeroplane", "bicycle",     "bird",  "boat",        "bottle", "bus",      "car",
    "cat",       "chair",       "cow",   "diningtable", "dog",    "horse",    "motorbike",
    "person",    "pottedplant", "sheep", "sofa",        "train",  "tvmonitor"};

using Shapes = std::vector<TensorShape>;

// Names are added last, because the kind determines the number of classes.
struct Found {
  NetworkExport network;
  std::int64_t classes = 0;
  bool with_background = false;
};

std::vector<std::size_t> outputs_of_rank(const Shapes& shapes, std::size_t rank) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].size() == rank) found.push_back(i);
  }
  return found;
}

std::optional<Found> as_class_map(const Shapes& shapes) {
  if (shapes.size() != 1) return std::nullopt;
  const TensorShape shape = without_batch(shapes[0], 2);
  const bool are_labels = shape.size() == 2;
  if (!are_labels && shape.size() != 3) return std::nullopt;
  const std::int64_t classes =
      are_labels ? static_cast<std::int64_t>(kVoc.size()) + 1 : std::min(shape[0], shape[2]);
  return Found{{ExportKind::kClassMap, {0}, {}}, classes, true};
}

std::optional<Found> as_yolo(const Shapes& shapes) {
  const std::vector<std::size_t> boxes = outputs_of_rank(shapes, 3);
  const std::vector<std::size_t> prototypes = outputs_of_rank(shapes, 4);
  if (shapes.size() != 2 || boxes.size() != 1 || prototypes.size() != 1) return std::nullopt;
  const TensorShape& shape = shapes[boxes[0]];
  const bool rows = shape[1] > shape[2];
  const std::int64_t classes =
      std::min(shape[1], shape[2]) - (rows ? 5 : 4) - shapes[prototypes[0]][1];
  const ExportKind kind = rows ? ExportKind::kYoloRows : ExportKind::kYoloColumns;
  return Found{{kind, {boxes[0], prototypes[0]}, {}}, classes, false};
}

std::optional<Found> as_ssd(const Shapes& shapes) {
  const std::vector<std::size_t> maps = outputs_of_rank(shapes, 4);
  const std::vector<std::size_t> anchors = outputs_of_rank(shapes, 2);
  const std::vector<std::size_t> rows = outputs_of_rank(shapes, 3);
  if (maps.size() != 1 || anchors.size() != 1 || rows.size() != 2) return std::nullopt;
  const bool offsets_first = shapes[rows[0]][2] == 4;
  const std::size_t offsets = rows[offsets_first ? 0 : 1], classes = rows[offsets_first ? 1 : 0];
  if (shapes[offsets][2] != 4) return std::nullopt;
  return Found{
      {ExportKind::kSsd, {anchors[0], offsets, classes, maps[0]}, {}}, shapes[classes][2], true};
}

// Pairs of outputs with equal numbers of rows. All boxes have the same number of columns, a
// multiple of 4, and all classes have the same number of columns, too.
std::optional<Found> as_nanodet(const Shapes& shapes) {
  const std::vector<std::size_t> rows = outputs_of_rank(shapes, 3);
  if (shapes.size() < 4 || shapes.size() % 2 != 0 || rows.size() != shapes.size()) {
    return std::nullopt;
  }
  Found found{{ExportKind::kNanoDet, {}, {}}, 0, false};
  std::vector<std::size_t> order = rows;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(shapes[a][1], shapes[a][2]) > std::pair(shapes[b][1], shapes[b][2]);
  });
  for (std::size_t i = 0; i < order.size(); i += 2) {
    const TensorShape &scores = shapes[order[i]], &boxes = shapes[order[i + 1]];
    const bool fit = scores[1] == boxes[1] && boxes[2] % 4 == 0 &&
                     scores[2] == shapes[order[0]][2] && boxes[2] == shapes[order[1]][2];
    if (!fit) return std::nullopt;
    found.network.outputs.insert(found.network.outputs.end(), {order[i], order[i + 1]});
    found.classes = scores[2];
  }
  return found;
}

std::optional<Found> as_centernet(const Shapes& shapes) {
  if (shapes.size() != 2 || outputs_of_rank(shapes, 4).size() != 2) return std::nullopt;
  const std::size_t sizes = shapes[0][3] == 4 ? 0 : 1;
  if (shapes[sizes][3] != 4) return std::nullopt;
  return Found{{ExportKind::kCenterNet, {1 - sizes, sizes}, {}}, shapes[1 - sizes][3], false};
}

// The names in the metadata of the network, else those of COCO or VOC, by their number.
std::vector<std::string> class_names(const NetworkSignature& signature, const Found& found) {
  const std::size_t background = found.with_background ? 1 : 0;
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(found.classes, 0));
  std::vector<std::string> names = quoted_words(signature.class_names);
  if (names.size() == count) return names;
  names.assign(background, "background");
  if (count == coco_class_names().size() + background) {
    names.insert(names.end(), coco_class_names().begin(), coco_class_names().end());
  } else if (count == kVoc.size() + background) {
    names.insert(names.end(), kVoc.begin(), kVoc.end());
  }
  if (count == 0 || names.size() != count) {
    throw Error(
        "a network of {} classes without their names: expected those of COCO or VOC, or as many "
        "names in its metadata entry 'names'",
        found.classes);
  }
  return names;
}

}  // namespace

TensorShape image_input_shape(const NetworkSignature& signature, cv::Size image) {
  const TensorShape shape =
      signature.inputs.size() == 1 ? signature.inputs[0].shape : TensorShape();
  const bool first = shape.size() == 4 && shape[1] == 3;
  const bool last = shape.size() == 4 && !first && shape[3] == 3;
  if ((!first && !last) || shape[0] > 1) {
    throw Error("a network with the input {}: expected one image, 1x3xHxW or 1xHxWx3",
                shape_text(shape));
  }
  constexpr std::int64_t kStep = 32, kMostSide = 8192;
  const auto size_or = [&](std::int64_t size, int image_size) {
    return size > 0 ? size : (image_size + kStep - 1) / kStep * kStep;
  };
  const std::int64_t height = size_or(shape[first ? 2 : 1], image.height);
  const std::int64_t width = size_or(shape[first ? 3 : 2], image.width);
  if (height > kMostSide || width > kMostSide) {
    throw Error("a network for images of {}x{} pixels, expected at most {} a side",
                width,
                height,
                kMostSide);
  }
  return first ? TensorShape{1, 3, height, width} : TensorShape{1, height, width, 3};
}

NetworkExport identify_export(const NetworkSignature& signature, const Shapes& outputs) {
  for (const auto& kind : {as_class_map, as_yolo, as_ssd, as_nanodet, as_centernet}) {
    std::optional<Found> found = kind(outputs);
    if (!found) continue;
    found->network.names = class_names(signature, *found);
    return std::move(found->network);
  }
  std::vector<std::string> texts;
  for (const TensorShape& shape : outputs) texts.push_back(shape_text(shape));
  throw Error(
      "a network with the outputs {}: expected a class map, YOLO segmentation, BlitzNet, NanoDet "
      "or CenterNet",
      joined(texts, ", "));
}

std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char quote = text[i];
    if (quote != '\'' && quote != '"') continue;
    const std::size_t end = text.find(quote, i + 1);
    if (end == std::string_view::npos) break;
    words.emplace_back(text.substr(i + 1, end - i - 1));
    i = end;
  }
  return words;
}

}  // namespace stillmap
