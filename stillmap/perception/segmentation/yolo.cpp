// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/yolo.hpp"

#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Access to boxes and prototypes by meaning.
struct Yolo {
  std::size_t boxes = 0, attributes = 0, classes = 0, prototypes = 0;
  std::size_t first_class = 0;
  std::size_t box_step = 0, attribute_step = 0;
  std::span<const float> values;
  cv::Size plane;

  [[nodiscard]] float at(std::size_t box, std::size_t attribute) const {
    return values[box * box_step + attribute * attribute_step];
  }
};

bool is_complete(const TensorShape& shape, const TensorView& output, std::size_t rank) {
  return shape.size() == rank && element_count(shape) > 0 &&
         element_count(shape) == std::ssize(output.values);
}

Yolo understand(const YoloOutputs& outputs) {
  const TensorShape boxes = without_batch(outputs.boxes.shape, 2);
  const TensorShape planes = without_batch(outputs.prototypes.shape, 3);
  Yolo yolo;
  if (is_complete(boxes, outputs.boxes, 2) && is_complete(planes, outputs.prototypes, 3)) {
    const bool rows = outputs.layout == YoloLayout::kRows;
    yolo.boxes = static_cast<std::size_t>(boxes[rows ? 0 : 1]);
    yolo.attributes = static_cast<std::size_t>(boxes[rows ? 1 : 0]);
    yolo.prototypes = static_cast<std::size_t>(planes[0]);
    yolo.first_class = rows ? 5 : 4;
    yolo.box_step = rows ? yolo.attributes : 1;
    yolo.attribute_step = rows ? 1 : yolo.boxes;
    yolo.values = outputs.boxes.values;
    yolo.plane = {static_cast<int>(planes[2]), static_cast<int>(planes[1])};
  }
  if (yolo.attributes <= yolo.first_class + yolo.prototypes) {
    throw Error("YOLO's outputs {} and {}: expected 1xNx(5+C+P) or 1x(4+C+P)xN, and 1xPxHxW",
                shape_text(outputs.boxes.shape),
                shape_text(outputs.prototypes.shape));
  }
  yolo.classes = yolo.attributes - yolo.first_class - yolo.prototypes;
  return yolo;
}

PixelBox box_of(const Yolo& yolo, std::size_t box) {
  const double x = yolo.at(box, 0), y = yolo.at(box, 1);
  const double half_width = yolo.at(box, 2) / 2.0, half_height = yolo.at(box, 3) / 2.0;
  return {x - half_width, y - half_height, x + half_width, y + half_height};
}

cv::Mat1f mask_logits(const Yolo& yolo, const TensorView& prototypes, std::size_t box) {
  cv::Mat1f sum = cv::Mat1f::zeros(yolo.plane);
  const std::size_t area = sum.total();
  float* const target = sum.ptr<float>();
  for (std::size_t p = 0; p < yolo.prototypes; ++p) {
    const float weight = yolo.at(box, yolo.first_class + yolo.classes + p);
    const std::span<const float> plane = prototypes.values.subspan(p * area, area);
    for (std::size_t i = 0; i < area; ++i) target[i] += weight * plane[i];
  }
  return sum;
}

}  // namespace

int yolo_class_count(const YoloOutputs& outputs) {
  return static_cast<int>(understand(outputs).classes);
}

std::vector<Candidate> decode_yolo_boxes(const YoloOutputs& outputs, float min_score) {
  const Yolo yolo = understand(outputs);
  std::vector<Candidate> candidates;
  for (std::size_t box = 0; box < yolo.boxes; ++box) {
    std::size_t best = 0;
    for (std::size_t c = 1; c < yolo.classes; ++c) {
      if (yolo.at(box, yolo.first_class + c) > yolo.at(box, yolo.first_class + best)) best = c;
    }
    const float object = outputs.layout == YoloLayout::kRows ? yolo.at(box, 4) : 1.0F;
    const float score = object * yolo.at(box, yolo.first_class + best);
    if (!(score >= min_score)) continue;
    candidates.push_back({static_cast<int>(best), score, box_of(yolo, box), static_cast<int>(box)});
  }
  return candidates;
}

std::vector<FoundObject> yolo_objects(const YoloOutputs& outputs,
                                      const std::vector<Candidate>& candidates,
                                      const std::vector<std::string>& names,
                                      const InputPlacement& placement,
                                      cv::Size image) {
  const Yolo yolo = understand(outputs);
  const InputPlacement onto = placement.onto(yolo.plane);
  std::vector<FoundObject> objects;
  for (const Candidate& candidate : candidates) {
    const auto box = static_cast<std::size_t>(candidate.source);
    const auto label = static_cast<std::size_t>(candidate.label);
    if (label >= names.size() || box >= yolo.boxes) continue;
    FoundObject object;
    object.class_name = names[label];
    object.score = candidate.score;
    object.box = placement.to_image(candidate.box);
    object.region = pixels_in(object.box, image);
    const cv::Mat1f logits = mask_logits(yolo, outputs.prototypes, box);
    object.mask = sample_at_image(logits, onto, object.region, -1) > 0;
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace stillmap
