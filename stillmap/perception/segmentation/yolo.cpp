// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/yolo.hpp"

#include <cmath>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Access to boxes and prototypes by meaning.
struct Yolo {
  YoloLayout layout = YoloLayout::kColumns;
  std::size_t boxes = 0, attributes = 0, classes = 0, prototypes = 0;
  std::size_t first_coefficient = 0;
  std::size_t box_step = 0, attribute_step = 0;
  std::span<const float> values;
  cv::Size plane;

  [[nodiscard]] float at(std::size_t box, std::size_t attribute) const {
    return values[box * box_step + attribute * attribute_step];
  }
  [[nodiscard]] std::size_t first_class() const { return layout == YoloLayout::kRows ? 5 : 4; }
};

bool is_complete(const TensorShape& shape, const TensorView& output, std::size_t rank) {
  return shape.size() == rank && element_count(shape) == std::ssize(output.values);
}

[[noreturn]] void refuse(const YoloOutputs& outputs, std::size_t classes) {
  throw Error(
      "YOLO's outputs {} and {} for {} classes C: expected 1xNx(5+C+P), 1x(4+C+P)xN or 1xNx(6+P), "
      "and 1xPxHxW",
      shape_text(outputs.boxes.shape),
      outputs.prototypes.shape.empty() ? "none" : shape_text(outputs.prototypes.shape),
      classes);
}

Yolo understand(const YoloOutputs& outputs, std::size_t classes) {
  const TensorShape boxes = without_batch(outputs.boxes.shape, 2);
  const TensorShape planes = without_batch(outputs.prototypes.shape, 3);
  const bool has_planes = !planes.empty();
  if (!is_complete(boxes, outputs.boxes, 2) ||
      (has_planes && !is_complete(planes, outputs.prototypes, 3))) {
    refuse(outputs, classes);
  }
  const bool rows = outputs.layout != YoloLayout::kColumns;
  Yolo yolo;
  yolo.layout = outputs.layout;
  yolo.classes = classes;
  yolo.boxes = static_cast<std::size_t>(boxes[rows ? 0 : 1]);
  yolo.attributes = static_cast<std::size_t>(boxes[rows ? 1 : 0]);
  yolo.box_step = rows ? yolo.attributes : 1;
  yolo.attribute_step = rows ? 1 : yolo.boxes;
  yolo.values = outputs.boxes.values;
  yolo.first_coefficient =
      outputs.layout == YoloLayout::kFinal ? 6 : yolo.first_class() + yolo.classes;
  if (has_planes) {
    yolo.prototypes = static_cast<std::size_t>(planes[0]);
    yolo.plane = {static_cast<int>(planes[2]), static_cast<int>(planes[1])};
  }
  if (classes == 0 || yolo.attributes != yolo.first_coefficient + yolo.prototypes) {
    refuse(outputs, classes);
  }
  return yolo;
}

float checked_score(float score) {
  if (is_no_probability(score)) throw Error(no_probability_text(score));
  return score;
}

PixelBox box_of(const Yolo& yolo, std::size_t box) {
  const double x = yolo.at(box, 0), y = yolo.at(box, 1);
  if (yolo.layout == YoloLayout::kFinal) return {x, y, yolo.at(box, 2), yolo.at(box, 3)};
  const double half_width = yolo.at(box, 2) / 2.0, half_height = yolo.at(box, 3) / 2.0;
  return {x - half_width, y - half_height, x + half_width, y + half_height};
}

// The best class of a box and its score.
Candidate scored(const Yolo& yolo, std::size_t box) {
  const std::size_t first = yolo.first_class();
  std::size_t best = 0;
  for (std::size_t c = 1; c < yolo.classes; ++c) {
    if (yolo.at(box, first + c) > yolo.at(box, first + best)) best = c;
  }
  const float object = yolo.layout == YoloLayout::kRows ? checked_score(yolo.at(box, 4)) : 1.0F;
  const float score = object * checked_score(yolo.at(box, first + best));
  return {static_cast<int>(best), score, box_of(yolo, box), static_cast<int>(box)};
}

// Rows without an object may have any whole number as class.
Candidate final_row(const Yolo& yolo, std::size_t box, float min_score) {
  const float score = checked_score(yolo.at(box, 4)), label = yolo.at(box, 5);
  const bool counts = score >= min_score;
  const bool known = label >= 0 && label < static_cast<float>(yolo.classes);
  if (label != std::floor(label) || (counts && !known)) {
    throw Error(
        "a class number of {}, expected whole numbers from 0 to {}", label, yolo.classes - 1);
  }
  return {known ? static_cast<int>(label) : 0, score, box_of(yolo, box), static_cast<int>(box)};
}

cv::Mat1f mask_logits(const Yolo& yolo, const TensorView& prototypes, std::size_t box) {
  cv::Mat1f sum = cv::Mat1f::zeros(yolo.plane);
  const std::size_t area = sum.total();
  float* const target = sum.ptr<float>();
  for (std::size_t p = 0; p < yolo.prototypes; ++p) {
    const float weight = yolo.at(box, yolo.first_coefficient + p);
    const std::span<const float> plane = prototypes.values.subspan(p * area, area);
    for (std::size_t i = 0; i < area; ++i) target[i] += weight * plane[i];
  }
  return sum;
}

}  // namespace

YoloOutputs yolo_outputs(const NetworkExport& network, const std::vector<Tensor>& outputs) {
  YoloOutputs yolo;
  if (network.kind == ExportKind::kYoloRows) yolo.layout = YoloLayout::kRows;
  if (network.kind == ExportKind::kYoloFinal) yolo.layout = YoloLayout::kFinal;
  yolo.boxes = outputs.at(network.outputs.at(0)).view();
  if (network.outputs.size() > 1) yolo.prototypes = outputs.at(network.outputs[1]).view();
  return yolo;
}

std::vector<Candidate> decode_yolo_boxes(const YoloOutputs& outputs,
                                         std::size_t classes,
                                         float min_score) {
  const Yolo yolo = understand(outputs, classes);
  std::vector<Candidate> candidates;
  for (std::size_t box = 0; box < yolo.boxes; ++box) {
    const Candidate candidate =
        yolo.layout == YoloLayout::kFinal ? final_row(yolo, box, min_score) : scored(yolo, box);
    if (candidate.score >= min_score) candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<FoundObject> yolo_objects(const YoloOutputs& outputs,
                                      const std::vector<Candidate>& candidates,
                                      const std::vector<std::string>& names,
                                      const InputPlacement& placement,
                                      cv::Size image) {
  const Yolo yolo = understand(outputs, names.size());
  const bool has_masks = yolo.prototypes > 0;
  const InputPlacement onto = has_masks ? placement.onto(yolo.plane) : placement;
  std::vector<FoundObject> objects;
  for (const Candidate& candidate : candidates) {
    const auto box = static_cast<std::size_t>(candidate.source);
    const auto label = static_cast<std::size_t>(candidate.label);
    if (label >= names.size() || box >= yolo.boxes) continue;
    FoundObject object;
    object.class_name = names[label];
    object.score = candidate.score;
    object.box = placement.to_image(candidate.box);
    if (has_masks) {
      object.region = pixels_in(object.box, image);
      const cv::Mat1f logits = mask_logits(yolo, outputs.prototypes, box);
      object.mask = sample_at_image(logits, onto, object.region, -1) > 0;
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace stillmap
